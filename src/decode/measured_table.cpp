// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoding_table.hpp"

#include <cmath>
#include <string>

#include "decode/search/smooth_curve.hpp"
#include "decode/shared/marked_raw.hpp"
#include "decode/table_resolution.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

void require_one_each(const Eigen::VectorXd& list, const char* field, int columns) {
  require(list.size() == 0 || list.size() == columns, field,
          std::to_string(list.size()) + " entries",
          "must have one for each of the " + std::to_string(columns) + " columns");
}

Eigen::VectorXd exposure_s_of(const MeasuredTable& measured, const ExposureTime& exposure) {
  if (measured.exposure_s.size() > 0) return measured.exposure_s;
  const int exposures = measured.columns() / measured.taps;
  const auto given = static_cast<int>(exposure.each_s.size());
  require(given == 0 || given == exposures, "exposure_s", std::to_string(given) + " entries",
          "must be one number or one for each of the " + std::to_string(exposures) + " exposures");
  Eigen::VectorXd exposure_s(measured.columns());
  for (int i = 0; i < measured.columns(); ++i)
    exposure_s[i] = exposure.of(i / measured.taps, exposures);
  return exposure_s;
}

/// Returns the light of every column, which determines its shot noise.
Eigen::MatrixXd light_of(const Eigen::MatrixXd& correlation) {
  constexpr double rounding = 1e-9;
  Eigen::MatrixXd light = correlation;
  for (Eigen::Index k = 0; k < light.cols(); ++k) {
    const double largest = light.col(k).cwiseAbs().maxCoeff();
    if (light.col(k).minCoeff() < -rounding * largest) light.col(k).setConstant(largest);
  }
  return light.cwiseMax(0.0);
}

/// Raises zero-mean columns along ambient light until all values that depend on it are >= 0.
Eigen::MatrixXd raised(const Eigen::MatrixXd& correlation, const Eigen::VectorXd& ambient_gain) {
  if (ambient_gain.minCoeff() < 0.0) return correlation;
  double rise = 0.0;
  for (Eigen::Index k = 0; k < correlation.cols(); ++k)
    if (ambient_gain[k] > 0.0)
      rise = std::max(rise, -correlation.col(k).minCoeff() / ambient_gain[k]);
  if (rise == 0.0) return correlation;
  Eigen::MatrixXd light = correlation.rowwise() + rise * ambient_gain.transpose();
  for (Eigen::Index k = 0; k < correlation.cols(); ++k)
    if (ambient_gain[k] > 0.0) light.col(k) = light.col(k).cwiseMax(0.0);
  return light;
}

Eigen::VectorXd of_pairs(const Eigen::VectorXd& values, const char* field) {
  Eigen::VectorXd shared(values.size() / 2);
  for (Eigen::Index i = 0; i < shared.size(); ++i) {
    require(values[2 * i] == values[2 * i + 1], field, values[2 * i + 1],
            "must be equal for both taps if their difference is read out");
    shared[i] = values[2 * i];
  }
  return shared;
}

}  // namespace

Eigen::VectorXd ambient_gain_of(const Eigen::MatrixXd& correlation, MeasuredAmbient ambient) {
  if (ambient == MeasuredAmbient::mean) return correlation.colwise().mean();
  return Eigen::VectorXd::Constant(correlation.cols(),
                                   ambient == MeasuredAmbient::none ? 0.0 : 1.0);
}

MeasuredTable MeasuredTable::in_order(const Eigen::VectorXi& source) const {
  MeasuredTable ordered = *this;
  ordered.correlation = correlation(Eigen::all, source).eval();
  for (Eigen::VectorXd* list :
       {&ordered.ambient_gain, &ordered.exposure_s, &ordered.black_level, &ordered.gain_e_per_raw})
    if (list->size() > 0) *list = (*list)(source).eval();
  return ordered;
}

void MeasuredTable::validate() const {
  require(columns() >= 1, "columns of the measured table", columns(), "must be >= 1");
  require(!differences || taps == 1, "taps of the measured table", taps,
          "must be 1 if its columns are differences");
  require(taps >= 1 && columns() % taps == 0, "columns of the measured table", columns(),
          "must be a multiple of taps = " + std::to_string(taps));
  require_one_each(ambient_gain, "ambient_gain", columns());
  require_one_each(exposure_s, "exposure_s", columns());
  require_one_each(black_level, "black_level", columns());
  require_one_each(gain_e_per_raw, "gain_e_per_raw", columns());
  if (correction) correction->validate();
  require(model_error_percent >= 0.0 && model_error_percent <= 100.0, "model_error_percent",
          model_error_percent, "must be in [0, 100]");
  if (range_m)
    require(std::isfinite(*range_m) && *range_m > 0.0, "range_m", *range_m,
            "must be finite and > 0");
}

namespace {

/// Converts a table to the camera's temperature: shifts it by the depth offset along the chords
/// between rows, and scales it by the change of the signal.
void warm(const Temperature& temperature, double bin_m, Eigen::MatrixXd& table) {
  const Eigen::MatrixXd cold = table;
  const Eigen::Index samples = cold.rows();
  const double bins = temperature.offset_m() / bin_m;
  const double whole = std::floor(bins), part = bins - whole;
  const auto wrapped = static_cast<Eigen::Index>(
      whole - std::floor(whole / static_cast<double>(samples)) * static_cast<double>(samples));
  for (Eigen::Index n = 0; n < samples; ++n)
    table.row(n) = temperature.signal_gain() * ((1.0 - part) * cold.row((n + wrapped) % samples) +
                                                part * cold.row((n + wrapped + 1) % samples));
}

}  // namespace

DecodingTable make_decoding_table(const MeasuredTable& measured, const Camera& camera) {
  camera.validate();
  measured.validate();
  const Sensor& sensor = camera.sensor;
  const int columns = measured.columns();
  require(sensor.readout != Readout::rows, "sensor.readout", "rows",
          "must be separate or difference, because the noise model of a measured table is that of "
          "taps");
  const bool differs = sensor.subtracts();
  require(!measured.differences || differs, "readout", "separate",
          "must be difference, because the measured table contains differences of taps");
  require(!sensor.is_signed() || measured.differences, "differences of the measured table", 0,
          "must be 1 with sensor.demodulation = \"signed\", whose measurements are signed");
  const bool subtracts = differs && !measured.differences;
  require(!subtracts || measured.taps == 2, "taps of the measured table", measured.taps,
          "must be 2 if the camera reads differences");
  const Eigen::MatrixXd readout =
      readout_matrix(columns, subtracts ? Readout::difference : Readout::separate);
  const Eigen::MatrixXd sums = readout.cwiseAbs();
  // Read noise and dark electrons of both taps.
  const double taps_read = measured.differences && !sensor.is_signed() ? 2.0 : 1.0;

  const Eigen::VectorXd exposure_s = exposure_s_of(measured, camera.exposure_s);
  const Eigen::VectorXd ambient_gain =
      measured.ambient_gain.size() > 0
          ? measured.ambient_gain
          : ambient_gain_of(measured.correlation,
                            measured.differences ? MeasuredAmbient::none : MeasuredAmbient::equal);
  const Eigen::VectorXd gain_e_per_raw =
      measured.gain_e_per_raw.size() > 0
          ? measured.gain_e_per_raw
          : Eigen::VectorXd::Constant(columns, sensor.gain_e_per_dn.value_or(1.0));
  const Eigen::VectorXd black_level =
      measured.black_level.size() > 0
          ? measured.black_level
          : Eigen::VectorXd::Constant(columns, measured.differences && !sensor.is_signed()
                                                   ? 0.0
                                                   : sensor.black_level_dn.value_or(0.0));
  const Eigen::VectorXd dark_e = sensor.dark_current_e_per_s * exposure_s;

  Eigen::MatrixXd correlation = without_noise_above_band_limit(measured.correlation);
  if (!measured.differences) correlation = raised(correlation, ambient_gain);
  DecodingTable table =
      table_of_rows(correlation * readout.transpose(), measured.range_m.value_or(camera.range_m()));
  table.exposures = columns / measured.taps;
  table.ambient_gain = readout * ambient_gain;
  table.exposure_s = subtracts ? of_pairs(exposure_s, "exposure_s") : exposure_s;
  table.gain_e_per_raw = subtracts ? of_pairs(gain_e_per_raw, "gain_e_per_raw") : gain_e_per_raw;
  table.black_level = readout * black_level;
  table.dark_electrons =
      measured.differences ? Eigen::VectorXd::Zero(columns).eval() : (readout * dark_e).eval();
  const Eigen::MatrixXd light = light_of(correlation);
  // Without shot terms, the measurements themselves determine the shot noise.
  if (differs || light != correlation || ambient_gain.minCoeff() < 0.0) {
    table.shot_correlation = light * sums.transpose();
    table.shot_ambient_gain = sums * ambient_gain.cwiseAbs();
    table.shot_dark_electrons = taps_read * (sums * dark_e);
  }
  table.constant_variance_e2 = taps_read * constant_variance_e2_of(sensor) * sums.rowwise().sum();
  table.hidden_ambient_e_per_s = camera.operating.middle().ambient_e_per_s;
  table.working_distance_m = camera.operating.working_distance_m;
  table = resolved(table);
  if (camera.temperature) {
    warm(*camera.temperature, table.row_m(), table.correlation);
    if (table.shot_correlation.size() > 0)
      warm(*camera.temperature, table.row_m(), table.shot_correlation);
  }
  table.correction = measured.correction;
  table.model_error_percent = measured.model_error_percent;
  set_saturation(camera, table);
  // The black level of the table also applies to unsigned numbers.
  if (measured.black_level.size() > 0) table.marking.unsigned_black_level = 0.0;
  return table;
}

}  // namespace tofsmith

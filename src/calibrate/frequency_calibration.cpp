// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/frequency_calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <set>

#include "calibrate/harmonic_fit.hpp"
#include "calibrate/reference_samples.hpp"
#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t min_pixels = 100;

ReferencePixels reference_pixels(const RawFrames& frames, const ReferenceDepth& reference,
                                 const DecodingTable& table) {
  constexpr double max_pixels = 2e4;
  constexpr double enough_tiles = 400.0;
  const double all = static_cast<double>(frames.pixels_per_frame()) * frames.frames;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(all / max_pixels))));
  const int k = frames.measurements;
  const int side = static_cast<int>(
      std::ceil(std::sqrt(static_cast<double>(frames.pixels_per_frame()) / enough_tiles)));
  const int tile_columns = (frames.width + side - 1) / side;
  const double highest = table.saturation_level.value_or(INFINITY);
  const double lowest = table.lower_saturation_level.value_or(-INFINITY);
  ReferencePixels pixels;
  pixels.tiles = tile_columns * ((frames.height + side - 1) / side);
  std::vector<double> electrons;
  for (int f = 0; f < frames.frames; ++f)
    for (int row = f % stride; row < frames.height; row += stride)
      for (int column = f % stride; column < frames.width; column += stride) {
        const double depth_m = reference_at(reference, f, row, column);
        const float* raw = frames.frame(f) + (std::ptrdiff_t{row} * frames.width + column) * k;
        const bool is_valid = std::all_of(
            raw, raw + k, [&](float number) { return number > lowest && number < highest; });
        if (!(depth_m > 0.0) || !is_valid) continue;
        for (int i = 0; i < k; ++i)
          electrons.push_back((static_cast<double>(raw[i]) - table.black_level[i]) *
                                  table.gain_e_per_raw[i] -
                              table.dark_electrons[i]);
        pixels.depth_m.push_back(depth_m);
        pixels.tile.push_back(row / side * tile_columns + column / side);
      }
  pixels.electrons = Eigen::Map<Eigen::MatrixXd>(electrons.data(), k,
                                                 static_cast<Eigen::Index>(pixels.depth_m.size()));
  return pixels;
}

Fundamentals fundamentals_of(const CodeSet& code, const Camera& camera,
                             const std::vector<int>& repetitions) {
  constexpr int points_per_repetition = 1024;
  const ForwardModel model(code, camera);
  const int fine = std::max(1, points_per_repetition * repetitions.back() / code.samples());
  Fundamentals found{.table = make_decoding_table(model, camera), .repetitions = repetitions};
  found.table.correlation = model.correlation_table(fine * code.samples());
  Eigen::VectorXcd spectrum;
  for (int i = 0; i < found.measurements(); ++i) {
    PeriodicTransform(found.table.samples()).forward(found.table.correlation.col(i), spectrum);
    const auto strength = [&](int n) { return std::norm(spectrum[n]); };
    const auto strongest = std::ranges::max_element(repetitions, {}, strength);
    found.frequency.push_back(static_cast<std::size_t>(strongest - repetitions.begin()));
    found.harmonic.push_back(spectrum[*strongest] / static_cast<double>(found.table.samples()));
  }
  return found;
}

/// Phasor S exp(i phase) of each frequency and pixel, (F, P); empty if it is not determined.
Eigen::MatrixXcd phasors_of(const Fundamentals& model, const ReferencePixels& pixels) {
  constexpr double independent = 1e-6;
  const auto frequencies = static_cast<Eigen::Index>(model.repetitions.size());
  const Eigen::VectorXd& exposure_s = model.table.exposure_s;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(model.measurements(), 2 * frequencies + 1);
  for (int i = 0; i < model.measurements(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto column = 2 * static_cast<Eigen::Index>(model.frequency[k]);
    system(i, column) = 2 * exposure_s[i] * model.harmonic[k].real();
    system(i, column + 1) = -2 * exposure_s[i] * model.harmonic[k].imag();
  }
  system.rightCols(1) = exposure_s.cwiseProduct(model.table.ambient_gain);
  const bool sees_ambient = system.rightCols(1).norm() > independent * system.norm();
  if (!sees_ambient) system.conservativeResize(Eigen::NoChange, 2 * frequencies);
  const auto [rank, inverse] = pseudo_inverse(system, independent);
  if (rank < system.cols()) return {};
  const Eigen::MatrixXd parts = inverse * pixels.electrons;
  Eigen::MatrixXcd phasors(frequencies, pixels.size());
  for (Eigen::Index f = 0; f < frequencies; ++f) {
    phasors.row(f).real() = parts.row(2 * f);
    phasors.row(f).imag() = parts.row(2 * f + 1);
  }
  return phasors;
}

struct PhasorOffsets {
  std::vector<double> offset_rad, contrast;
  double agreement = 0.0;  // minimum over frequencies; at most 1
};

PhasorOffsets offsets_of(const Fundamentals& model, const ReferencePixels& pixels,
                         const Eigen::MatrixXcd& phasors) {
  PhasorOffsets found{.agreement = 1.0};
  const Eigen::RowVectorXd log_mean = phasors.cwiseAbs().array().log().colwise().mean();
  for (Eigen::Index f = 0; f < phasors.rows(); ++f) {
    std::complex<double> sum = 0.0;
    std::vector<double> log_contrast;
    for (Eigen::Index p = 0; p < phasors.cols(); ++p) {
      const double length = std::abs(phasors(f, p));
      if (!(length > 0.0)) continue;
      sum += phasors(f, p) / length *
             std::polar(1.0, -model.phase_rad(static_cast<std::size_t>(f),
                                              pixels.depth_m[static_cast<std::size_t>(p)]));
      log_contrast.push_back(std::log(length) - log_mean[p]);
    }
    found.offset_rad.push_back(std::arg(sum));
    found.contrast.push_back(std::exp(median_of(std::move(log_contrast))));
    found.agreement =
        std::min(found.agreement, std::abs(sum) / static_cast<double>(phasors.cols()));
  }
  return found;
}

struct CalibratedCamera {
  Camera camera;
  std::vector<double> offset_m, contrast;  // per exposure of the code
};

std::vector<std::size_t> frequency_of_exposures(const CodeSet& code,
                                                const std::vector<int>& repetitions) {
  std::vector<std::size_t> frequency;
  for (int e = 0; e < code.exposures(); ++e)
    frequency.push_back(static_cast<std::size_t>(
        std::ranges::lower_bound(repetitions, code.modulation(e).repetitions()) -
        repetitions.begin()));
  return frequency;
}

/// Shifts offsets by phases and scales contrasts, whose geometric mean is kept unless one would
/// exceed 1.
void adjust(CalibratedCamera& calibrated, const std::vector<std::size_t>& frequency,
            const std::vector<int>& repetitions, const std::vector<double>& offset_rad,
            const std::vector<double>& contrast) {
  Camera& camera = calibrated.camera;
  for (std::size_t e = 0; e < frequency.size(); ++e) {
    const double period_m = camera.range_m() / repetitions[frequency[e]];
    calibrated.offset_m[e] = wrapped_difference_m(
        calibrated.offset_m[e] + offset_rad[frequency[e]] / turn * period_m, period_m);
    if (camera.sensor.mixes_taps()) calibrated.contrast[e] *= contrast[frequency[e]];
  }
  const double largest = std::ranges::max(calibrated.contrast);
  if (largest > 1.0)
    for (double& c : calibrated.contrast) c /= largest;
  camera.playback = camera.playback.value_or(Playback());
  camera.playback->set_offsets_m(calibrated.offset_m);
  if (camera.sensor.mixes_taps()) camera.sensor.modulation_contrasts = calibrated.contrast;
}

/// "2 to 8" or "3, 5, 7".
std::string list_of(const std::vector<int>& numbers) {
  const bool is_run = numbers.back() - numbers.front() + 1 == static_cast<int>(numbers.size());
  if (is_run && numbers.size() > 2) return fmt::format("{} to {}", numbers.front(), numbers.back());
  return fmt::format("{}", fmt::join(numbers, ", "));
}

/// Adds standard errors and harmonics to `found`, which contains frequency, offset and contrast.
/// @param notes   receives a note on undetermined parameters
void add_fit(const HarmonicFit& fit, std::size_t frequency, double period_m,
             CalibratedFrequency& found, std::vector<std::string>& notes) {
  constexpr int noted_harmonic = 8;
  const std::size_t fundamental = fit.fundamental(frequency);
  const std::complex<double> gain = fit.gain(frequency);
  const double size = std::abs(gain);
  found.offset_m.standard_error = fit.standard_errors(fundamental)[1] / size / turn * period_m;
  found.contrast.standard_error = found.contrast.value * fit.contrast_error(frequency);
  std::vector<int> unknown;
  for (std::size_t t = 0; t < fit.terms().size(); ++t) {
    const auto [its_frequency, harmonic] = fit.terms()[t];
    if (its_frequency != frequency || harmonic == 1) continue;
    if (fit.is_determined(t)) {
      const std::complex<double> share =
          fit.deviation(t) * std::polar(1.0 / size, -harmonic * std::arg(gain));
      const auto [real_error, imaginary_error] = fit.standard_errors(t);
      found.harmonics.push_back(
          {harmonic, {share.real(), real_error / size}, {share.imag(), imaginary_error / size}});
    } else if (harmonic <= noted_harmonic) {
      unknown.push_back(harmonic);
    }
  }
  const std::string name = fmt::format("{:.6g} MHz", 1e-6 * found.frequency_hz);
  if (!fit.is_determined(fundamental))
    notes.push_back(fmt::format("{}: the offset is not determined by these frames", name));
  if (!unknown.empty())
    notes.push_back(
        fmt::format("{}: harmonics {} are not determined by these frames and remain as in the "
                    "camera's model; depths over its whole period, {:.3g} m, determine them",
                    name, list_of(unknown), period_m));
}

/// Frequencies in units of f0, increasing.
std::vector<int> repetitions_of(const CodeSet& code) {
  std::set<int> found;
  for (const int e : code.frequency_starts()) found.insert(code.modulation(e).repetitions());
  return {found.begin(), found.end()};
}

}  // namespace

std::optional<FrequencyCalibration> calibrate_frequencies(const RawFrames& frames,
                                                          const ReferenceDepth& reference,
                                                          const CodeSet& code,
                                                          const Camera& camera) {
  if (code.is_rows()) return std::nullopt;
  const std::vector<int> repetitions = repetitions_of(code);
  if (repetitions.size() < 2) return std::nullopt;
  const std::vector<std::size_t> frequency = frequency_of_exposures(code, repetitions);

  // Determine direction of delay, offsets and contrasts from the phases.
  constexpr double agrees = 0.6, clearly = 0.05;
  CalibratedCamera calibrated{
      camera, camera.playback.value_or(Playback()).offsets_of(code, camera.range_m()),
      camera.sensor.contrasts_of(code)};
  const ReferencePixels pixels =
      reference_pixels(frames, reference, make_decoding_table(ForwardModel(code, camera), camera));
  if (pixels.depth_m.size() < min_pixels) return std::nullopt;
  PhasorOffsets offsets;
  FrequencyCalibration result;
  for (const bool reversed : {false, true}) {
    Camera tried = camera;
    if (reversed) {
      tried.playback = tried.playback.value_or(Playback());
      tried.playback->reversed = !tried.playback->reversed;
    }
    const Fundamentals model = fundamentals_of(code, tried, repetitions);
    const Eigen::MatrixXcd phasors = phasors_of(model, pixels);
    if (phasors.size() == 0) return std::nullopt;
    const PhasorOffsets found = offsets_of(model, pixels, phasors);
    if (reversed && found.agreement < offsets.agreement + clearly) break;
    offsets = found;
    result.reversed = reversed;
    calibrated.camera = tried;
  }
  if (offsets.agreement < agrees) return std::nullopt;
  adjust(calibrated, frequency, repetitions, offsets.offset_rad, offsets.contrast);

  const Fundamentals model = fundamentals_of(code, calibrated.camera, repetitions);
  HarmonicFit fit(model, pixels, code.samples());
  fit.solve();
  result.correlation = ForwardModel(code, calibrated.camera).correlation_table(code.samples());
  for (Eigen::Index row = 0; row < result.correlation.rows(); ++row)
    result.correlation.row(row) +=
        fit.added(static_cast<double>(row) * model.table.range_m / code.samples()).transpose();
  std::vector<double> offset_rad, contrast;
  for (std::size_t f = 0; f < repetitions.size(); ++f) {
    offset_rad.push_back(std::arg(fit.gain(f)));
    contrast.push_back(std::abs(fit.gain(f)));
  }
  adjust(calibrated, frequency, repetitions, offset_rad, contrast);
  if (camera.sensor.mixes_taps())  // contrasts of the phases are already in the model
    std::ranges::transform(contrast, offsets.contrast, contrast.begin(), std::multiplies());
  double mean_log = 0.0;
  for (const double c : contrast) mean_log += std::log(c) / static_cast<double>(contrast.size());
  for (std::size_t f = 0; f < repetitions.size(); ++f) {
    const auto exposure = std::ranges::find(frequency, f) - frequency.begin();
    CalibratedFrequency found{
        .frequency_hz = repetitions[f] * camera.fundamental_frequency_hz,
        .offset_m = {calibrated.offset_m[static_cast<std::size_t>(exposure)], 0.0},
        .contrast = {contrast[f] / std::exp(mean_log), 0.0}};
    add_fit(fit, f, camera.range_m() / repetitions[f], found, result.notes);
    result.frequencies.push_back(std::move(found));
  }
  for (const int start : code.frequency_starts()) {
    result.offsets_m.push_back(calibrated.offset_m[static_cast<std::size_t>(start)]);
    result.contrasts.push_back(calibrated.contrast[static_cast<std::size_t>(start)]);
  }
  return result;
}

}  // namespace tofsmith

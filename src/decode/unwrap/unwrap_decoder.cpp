// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/unwrap_decoder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_kernel.hpp"
#include "decode/raw_scale.hpp"
#include "decode/shared/marked_raw.hpp"
#include "decode/unwrap/phase_unwrapper.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Measurement of one phase per frequency by a code of sinusoids,
///   chi_i(u) = c_i + 2 Re(C_i e^(2 pi i f_i u))
/// for a depth of u periods, so that
///   y_i = T_i (S c_i + A kappa_i) + 2 T_i Re(C_i q_f),   q_f = S e^(2 pi i f u)
/// is linear in the phasors q_f and in the offset. Unweighted least squares determine both: three
/// or more equally spaced phases determine their own offset; a quadrature pair uses the offset of
/// other frequencies. The offset T (S c + A kappa) is known up to a factor if all modulations have
/// the same mean; otherwise it lies in the span of two vectors.
class PhaseModel {
 public:
  /// @throws std::invalid_argument if a correlation function is not a single harmonic (up to
  ///   `largest_other_energy`, relative to its variance), if a frequency is measured at fewer than
  ///   two phases, if the offset is not determined, or if the frequencies share a divisor
  PhaseModel(const DecodingTable& table, double largest_other_energy);

  /// Frequencies in multiples of f0, ascending.
  const std::vector<int>& frequencies() const { return frequencies_; }
  int count() const { return static_cast<int>(frequencies_.size()); }

  /// Computes the phasors (count) of electrons without dark electrons (K).
  void phasors(const double* electrons, std::complex<double>* phasor) const;
  /// Derivative of phasor j with respect to measurement k [1/s].
  std::complex<double> gain(int j, int k) const { return gain_(j, k); }

 private:
  std::vector<int> frequencies_;
  Eigen::MatrixXcd gain_;  // (frequencies, K)
};

namespace {

// Relative limits below which a residual is a rounding error.
constexpr double no_variation = 1e-10;
constexpr double no_offset = 1e-9;
constexpr double no_second_phase = 1e-6;
/// Relative distance of c from a multiple of kappa due to small asymmetries.
constexpr double same_offset = 1e-3;

struct Harmonic {
  int frequency = 0;  ///< 0: constant
  double mean = 0.0;
  std::complex<double> coefficient;
};

Harmonic harmonic_of(const Eigen::VectorXd& correlation, int measurement,
                     double largest_other_energy) {
  Eigen::VectorXcd spectrum;
  PeriodicTransform(static_cast<int>(correlation.size())).forward(correlation, spectrum);
  spectrum /= static_cast<double>(correlation.size());
  Harmonic found{.mean = spectrum[0].real()};
  if (spectrum.size() < 2) return found;
  Eigen::VectorXd energy = spectrum.tail(spectrum.size() - 1).cwiseAbs2();
  if (correlation.size() % 2 == 0) energy[energy.size() - 1] /= 2;  // Nyquist
  const double whole = energy.sum();
  if (whole <= no_variation * no_variation * correlation.squaredNorm()) return found;
  Eigen::Index strongest = 0;
  const double other = 1.0 - energy.maxCoeff(&strongest) / whole;
  found.frequency = static_cast<int>(strongest) + 1;
  found.coefficient = spectrum[found.frequency];
  require(other <= largest_other_energy, fmt::format("correlation of measurement {}", measurement),
          fmt::format("{:.3g} % of its energy outside harmonic {}", 100 * other, found.frequency),
          fmt::format("must be at most {:.3g} %: phase unwrapping requires sinusoids",
                      100 * largest_other_energy));
  return found;
}

/// Returns true if the measurements differ in more than amplitude and sign.
bool sees_two_phases(const std::vector<Harmonic>& harmonics, int frequency) {
  std::vector<std::complex<double>> seen;
  for (const Harmonic& h : harmonics)
    if (h.frequency == frequency) seen.push_back(h.coefficient);
  Eigen::MatrixXd parts(static_cast<Eigen::Index>(seen.size()), 2);
  for (std::size_t i = 0; i < seen.size(); ++i)
    parts.row(static_cast<Eigen::Index>(i)) << seen[i].real(), seen[i].imag();
  const Eigen::VectorXd values = thin_svd(parts).values;
  return values.size() == 2 && values[1] > no_second_phase * values[0];
}

/// Possible offsets as columns: none if ambient light cancels, one for most codes.
Eigen::MatrixXd offset_columns(const DecodingTable& table, const Eigen::VectorXd& means) {
  const Eigen::VectorXd of_ambient = table.exposure_s.cwiseProduct(table.ambient_gain);
  const Eigen::VectorXd of_signal = table.exposure_s.cwiseProduct(means);
  const double nothing = no_offset * table.exposure_s.norm();
  Eigen::MatrixXd columns(table.measurements(), 2);
  Eigen::Index count = 0;
  if (of_ambient.norm() > nothing) columns.col(count++) = of_ambient.normalized();
  Eigen::VectorXd rest = of_signal;
  if (count == 1) rest -= columns.col(0) * columns.col(0).dot(of_signal);
  if (rest.norm() > std::max(nothing, same_offset * of_signal.norm()))
    columns.col(count++) = rest.normalized();
  return columns.leftCols(count);
}

}  // namespace

PhaseModel::PhaseModel(const DecodingTable& table, double largest_other_energy) {
  std::vector<Harmonic> harmonics;
  Eigen::VectorXd means(table.measurements());
  std::set<int> found;
  for (int k = 0; k < table.measurements(); ++k) {
    harmonics.push_back(harmonic_of(table.correlation.col(k), k, largest_other_energy));
    means[k] = harmonics.back().mean;
    if (harmonics.back().frequency > 0) found.insert(harmonics.back().frequency);
  }
  frequencies_.assign(found.begin(), found.end());
  for (const int frequency : frequencies_)
    require(sees_two_phases(harmonics, frequency), fmt::format("phases of harmonic {}", frequency),
            "one", "must be two or more that are not half a period apart");

  int common = 0;
  for (const int frequency : frequencies_) common = std::gcd(common, frequency);
  require(common == 1, "frequencies", fmt::format("{}", fmt::join(frequencies_, ", ")),
          fmt::format("must have no common divisor: depth repeats after {:.4g} of {:.4g} m",
                      table.range_m / std::max(common, 1), table.range_m));

  // Columns: the offset, then 2 T Re C and -2 T Im C for each frequency, normalized because the
  // camera may attenuate high frequencies.
  const Eigen::MatrixXd offsets = offset_columns(table, means);
  Eigen::MatrixXd system =
      Eigen::MatrixXd::Zero(table.measurements(), offsets.cols() + 2 * count());
  system.leftCols(offsets.cols()) = offsets;
  for (int j = 0; j < count(); ++j)
    for (int k = 0; k < table.measurements(); ++k) {
      const Harmonic& h = harmonics[static_cast<std::size_t>(k)];
      if (h.frequency != frequencies_[static_cast<std::size_t>(j)]) continue;
      const std::complex<double> c = 2 * table.exposure_s[k] * h.coefficient;
      system(k, offsets.cols() + 2 * j) = c.real();
      system(k, offsets.cols() + 2 * j + 1) = -c.imag();
    }
  const Eigen::RowVectorXd lengths = system.colwise().norm();
  system.array().rowwise() /= lengths.array();
  const auto [rank, inverse] = pseudo_inverse(system, no_offset);
  require(rank == system.cols(), "measurements", table.measurements(),
          fmt::format("must determine {} unknowns (two per frequency and {} for the offset of "
                      "signal and ambient light); use 3 phases for one frequency",
                      system.cols(), offsets.cols()));
  gain_.resize(count(), table.measurements());
  for (int j = 0; j < count(); ++j) {
    const Eigen::Index row = offsets.cols() + 2 * j;
    gain_.row(j).real() = inverse.row(row) / lengths[row];
    gain_.row(j).imag() = inverse.row(row + 1) / lengths[row + 1];
  }
}

void PhaseModel::phasors(const double* electrons, std::complex<double>* phasor) const {
  for (int j = 0; j < count(); ++j) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = 0; k < gain_.cols(); ++k) sum += gain_(j, k) * electrons[k];
    phasor[j] = sum;
  }
}

namespace {

constexpr double turn = 2 * std::numbers::pi;

/// The variance of a depth is proportional to the noise of its phasor divided by f^2. Assumes equal
/// noise in all measurements.
std::vector<double> weights_of(const PhaseModel& phases, int measurements, UnwrapWeights kind) {
  std::vector<double> weights;
  double sum = 0.0;
  for (int j = 0; j < phases.count(); ++j) {
    const double f = phases.frequencies()[static_cast<std::size_t>(j)];
    double noise = 0.0;
    for (int k = 0; k < measurements; ++k) noise += std::norm(phases.gain(j, k));
    weights.push_back(kind == UnwrapWeights::variance ? f * f / noise : f * f);
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

void UnwrapOptions::validate() const {
  status_thresholds.validate();
  require(largest_other_energy >= 0.0 && largest_other_energy <= 1.0,
          "UnwrapOptions::largest_other_energy", largest_other_energy, "must be in [0, 1]");
}

struct UnwrapDecoder::Plan {
  Plan(DecodingTable table_, const UnwrapOptions& options_, const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        scale(table),
        phases(table, options.largest_other_energy),
        weights(weights_of(phases, table.measurements(), options.weights)),
        unwrapper(phases.frequencies(), weights),
        model(table, projection),
        posterior(table, projection),
        residuals(table, projection, options.status_thresholds) {}

  using PerMeasurement = std::array<double, max_measurements>;
  using PerFrequency = std::array<double, max_frequencies>;

  DecodingTable table;
  UnwrapOptions options;
  RawScale scale;
  PhaseModel phases;
  std::vector<double> weights;
  PhaseUnwrapper unwrapper;
  PixelModel model;
  LobePosterior posterior;
  ResidualModel residuals;

  PerFrequency phases_of(const PerMeasurement& electrons) const;
  double row_of(const Wraps& wraps) const;
  void decode_pixel(const PixelToDecode& pixel, const DecodedView& decoded) const;
  double deviation(const PerFrequency& factor, const PixelDecoding& pixel,
                   const PerMeasurement& variance_e2) const;
};

UnwrapDecoder::UnwrapDecoder(DecodingTable table, const UnwrapOptions& options) {
  options.validate();
  table.validate();
  require_exposures(table, "phase unwrapping");
  const AmbientProjection projection(table);
  plan_ = make_hidden<const Plan>(std::move(table), options, projection);
}

const DecodingTable& UnwrapDecoder::table() const { return plan_->table; }
const std::vector<int>& UnwrapDecoder::frequencies() const { return plan_->phases.frequencies(); }
const std::vector<double>& UnwrapDecoder::weights() const { return plan_->weights; }

void UnwrapDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                      double* depth_bin) const {
  Plan::PerMeasurement electrons;
  const int count = this->measurements();
  for (std::int64_t i = 0; i < pixels; ++i) {
    depth_bin[i] = std::numeric_limits<double>::quiet_NaN();
    if (!plan_->scale.read(measurements + i * count, electrons.data())) continue;
    const Wraps wraps = plan_->unwrapper.nearest(plan_->phases_of(electrons).data());
    depth_bin[i] = plan_->table.in_bins(plan_->row_of(wraps));
  }
}

void UnwrapDecoder::decode_pixels(const RawView& raw, const RangePart* parts,
                                  const DecodedView& decoded, const Progress& progress) const {
  const int count = measurements();
  decode_frame(MarkedRaw(raw, table().marking).view(), decoded, count, progress,
               [&](const RawBlock& block, const DecodedView& planes) {
                 for (std::int64_t i = 0; i < block.pixels; ++i)
                   plan_->decode_pixel(block.pixel(i, count, parts), planes);
               });
}

UnwrapDecoder::Plan::PerFrequency UnwrapDecoder::Plan::phases_of(
    const PerMeasurement& electrons) const {
  std::array<std::complex<double>, max_frequencies> phasor;
  phases.phasors(electrons.data(), phasor.data());
  PerFrequency phase;
  for (std::size_t j = 0; j < weights.size(); ++j) phase[j] = std::arg(phasor[j]) / turn;
  return phase;
}

double UnwrapDecoder::Plan::row_of(const Wraps& wraps) const {
  return wrap(wraps.depth * table.samples(), table.samples());
}

void UnwrapDecoder::Plan::decode_pixel(const PixelToDecode& pixel,
                                       const DecodedView& decoded) const {
  PerMeasurement electrons, variance_e2, plane;
  if (!scale.read(pixel.raw, electrons.data())) return store_invalid(pixel.at, decoded);
  const PerFrequency phase = phases_of(electrons);
  const Wraps wraps = unwrapper.nearest(phase.data(), pixel.part);
  if (!std::isfinite(wraps.distance))
    return store_pixel(table, options.status_thresholds, pixel.raw, {}, pixel.at, decoded);

  model.project(electrons.data(), plane.data());
  PixelDecoding decoding{.depth_row = row_of(wraps)};
  decoding.estimate =
      model.estimate(electrons.data(), plane.data(), Position::at(decoding.depth_row),
                     variance_e2.data(), pixel.variance_share);
  if (decoding.estimate.signal_e_per_s > 0.0) {
    PerFrequency share;
    for (std::size_t j = 0; j < weights.size(); ++j) share[j] = weights[j] * table.samples();
    decoding.estimate.depth_standard_deviation_row = deviation(share, decoding, variance_e2);
    for (int k = 0; k < table.measurements(); ++k)
      variance_e2[static_cast<std::size_t>(k)] *= pixel.noise.of_lobes;
    decoding.set_confidence(posterior.confidence(plane.data(), variance_e2.data(),
                                                 nearest_bin(decoding.depth_row, table.samples()),
                                                 pixel.part));
  }
  store_pixel(table, options.status_thresholds, residuals, electrons.data(), decoding, pixel,
              decoded);
}

/// Returns the standard deviation of sum_f factor_f z_f. An electron in measurement k turns the
/// phasor S e^(2 pi i f z) by Im(gain_fk e^(-2 pi i f z)) / S.
double UnwrapDecoder::Plan::deviation(const PerFrequency& factor, const PixelDecoding& pixel,
                                      const PerMeasurement& variance_e2) const {
  PerMeasurement effect{};
  for (int j = 0; j < phases.count(); ++j) {
    const double f = phases.frequencies()[static_cast<std::size_t>(j)];
    const std::complex<double> back =
        std::polar(1.0, -turn * f * pixel.depth_row / table.samples());
    const double scaled =
        factor[static_cast<std::size_t>(j)] / (turn * f * pixel.estimate.signal_e_per_s);
    for (int k = 0; k < table.measurements(); ++k)
      effect[static_cast<std::size_t>(k)] += scaled * (phases.gain(j, k) * back).imag();
  }
  double variance = 0.0;
  for (int k = 0; k < table.measurements(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    variance += effect[i] * effect[i] * variance_e2[i];
  }
  return std::sqrt(variance);
}

}  // namespace tofsmith

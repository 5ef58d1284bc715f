// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/unwrap_decoder.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/shared/enum_words.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "decode/search/nearest_bins.hpp"
#include "decode/shared/marked_raw.hpp"
#include "decode/unwrap/phase_model.hpp"
#include "decode/unwrap/phase_unwrapper.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

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

constexpr EnumWords<UnwrapWeights, 2> weights_words("UnwrapWeights", "unwrap weights",
                                                    words_of(UnwrapWeights{}));

}  // namespace

std::string_view name_of(UnwrapWeights weights) { return weights_words.of(weights); }

UnwrapWeights parse_unwrap_weights(std::string_view name) { return weights_words.parse(name); }

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

  bool read(const float* raw, PerMeasurement& electrons) const;
  PerFrequency phases_of(const PerMeasurement& electrons) const;
  double row_of(const Wraps& wraps) const;
  void decode(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
              const Progress& progress) const;
  void decode_pixel(const float* raw, double variance_share, const NoiseRatios& noise,
                    const RangePart* part, std::size_t at, const DecodedView& decoded) const;
  double deviation(const PerFrequency& factor, const PixelDecoding& pixel,
                   const PerMeasurement& variance_e2) const;
};

UnwrapDecoder::UnwrapDecoder(DecodingTable table, const UnwrapOptions& options) {
  options.validate();
  table.validate();
  require_exposures(table, "phase unwrapping");
  const AmbientProjection projection(table);
  plan_ = std::make_unique<const Plan>(std::move(table), options, projection);
}
UnwrapDecoder::~UnwrapDecoder() = default;
UnwrapDecoder::UnwrapDecoder(UnwrapDecoder&&) noexcept = default;
UnwrapDecoder& UnwrapDecoder::operator=(UnwrapDecoder&&) noexcept = default;

const DecodingTable& UnwrapDecoder::table() const { return plan_->table; }
const UnwrapOptions& UnwrapDecoder::options() const { return plan_->options; }
const std::vector<int>& UnwrapDecoder::frequencies() const { return plan_->phases.frequencies(); }
const std::vector<double>& UnwrapDecoder::weights() const { return plan_->weights; }

void UnwrapDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                      double* depth_bin) const {
  Plan::PerMeasurement electrons;
  for (std::int64_t i = 0; i < pixels; ++i) {
    depth_bin[i] = std::numeric_limits<double>::quiet_NaN();
    if (!plan_->read(measurements + i * this->measurements(), electrons)) continue;
    const Wraps wraps = plan_->unwrapper.nearest(plan_->phases_of(electrons).data());
    depth_bin[i] = plan_->table.in_bins(plan_->row_of(wraps));
  }
}

void UnwrapDecoder::decode_bins(const float* measurements, std::int64_t pixels,
                                std::int32_t* bin) const {
  nearest_bins(*this, measurements, pixels, bin);
}

void UnwrapDecoder::decode(const RawView& raw, const DecodedView& decoded,
                           const Progress& progress) const {
  plan_->decode(raw, nullptr, decoded, progress);
}

void UnwrapDecoder::decode_within(const RawView& raw, const RangePart* parts,
                                  const DecodedView& decoded, const Progress& progress) const {
  plan_->decode(raw, parts, decoded, progress);
}

DepthImage UnwrapDecoder::decode(const RawFrames& raw, int frame, const Progress& progress) const {
  return decoded_image(raw, frame, [&](const RawView& view, const DecodedView& decoded) {
    decode(view, decoded, progress);
  });
}

void UnwrapDecoder::Plan::decode(const RawView& raw, const RangePart* parts,
                                 const DecodedView& decoded, const Progress& progress) const {
  const int count = table.measurements();
  decode_frame(MarkedRaw(raw, table.marking).view(), decoded, count, progress,
               [&](const RawBlock& block, const DecodedView& planes) {
                 for (std::int64_t i = 0; i < block.pixels; ++i)
                   decode_pixel(block.values + i * count, block.variance_share(i),
                                block.noise_of(i), parts ? parts + block.first + i : nullptr,
                                static_cast<std::size_t>(i), planes);
               });
}

bool UnwrapDecoder::Plan::read(const float* raw, PerMeasurement& electrons) const {
  bool finite = true;
  for (int k = 0; k < table.measurements(); ++k) {
    electrons[static_cast<std::size_t>(k)] = scale.electrons(raw[k], k);
    finite = finite && std::isfinite(raw[k]);
  }
  return finite;
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

void UnwrapDecoder::Plan::decode_pixel(const float* raw, double variance_share,
                                       const NoiseRatios& noise, const RangePart* part,
                                       std::size_t at, const DecodedView& decoded) const {
  PerMeasurement electrons, variance_e2, plane;
  if (!read(raw, electrons)) return store_invalid(at, decoded);
  const PerFrequency phase = phases_of(electrons);
  const Wraps wraps = unwrapper.nearest(phase.data(), part);
  if (!std::isfinite(wraps.distance))
    return store_pixel(table, options.status_thresholds, raw, {}, at, decoded);

  model.project(electrons.data(), plane.data());
  PixelDecoding pixel{.depth_row = row_of(wraps)};
  pixel.estimate = model.estimate(electrons.data(), plane.data(), Position::at(pixel.depth_row),
                                  variance_e2.data(), variance_share);
  if (pixel.estimate.signal_e_per_s > 0.0) {
    PerFrequency share;
    for (std::size_t j = 0; j < weights.size(); ++j) share[j] = weights[j] * table.samples();
    pixel.estimate.depth_standard_deviation_row = deviation(share, pixel, variance_e2);
    for (int k = 0; k < table.measurements(); ++k)
      variance_e2[static_cast<std::size_t>(k)] *= noise.of_lobes;
    const std::optional<double> confidence = posterior.confidence(
        plane.data(), variance_e2.data(), nearest_bin(pixel.depth_row, table.samples()), part);
    if (!confidence) return store_pixel(table, options.status_thresholds, raw, {}, at, decoded);
    pixel.confidence = *confidence;
    if (decoded.residual || decoded.status)
      pixel.residual =
          residuals.residual(electrons.data(), pixel.estimate, Position::at(pixel.depth_row),
                             variance_share * noise.of_residual);
  }
  store_pixel(table, options.status_thresholds, raw, pixel, at, decoded);
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

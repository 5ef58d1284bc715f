// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/likelihood_decoder.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "decode/likelihood/likelihood_search.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "decode/search/nearest_bins.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using PerMeasurement = std::array<double, max_measurements>;

}  // namespace

struct LikelihoodDecoder::Plan {
  /// @param white  whitened(table_)
  Plan(DecodingTable table_, const DecodeOptions& options_, const DecodingTable& white,
       const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        scale(table),
        search(white, projection),
        residuals(white, projection, options) {}

  DecodingTable table;
  DecodeOptions options;
  RawScale scale;
  LikelihoodSearch search;
  ResidualModel residuals;

  bool read(const float* raw, PerMeasurement& electrons) const;
  std::vector<double> work_space() const {
    return std::vector<double>(static_cast<std::size_t>(table.samples()));
  }
  double decode_depth_bin(const float* raw, std::vector<double>& fall) const;
  void decode(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
              const Progress& progress) const;
  void decode_pixel(const float* raw, double variance_share, const NoiseRatios& noise,
                    const RangePart* part, std::size_t at, const DecodedView& decoded,
                    std::vector<double>& fall) const;
};

LikelihoodDecoder::LikelihoodDecoder(DecodingTable table, const DecodeOptions& options) {
  options.validate();
  table.validate();
  require(table.decoder == RowDecoder::whitened, "sensor.decoder", "plain",
          "must be \"whitened\" for ml, which takes the correlation of the noise into account");
  const DecodingTable white = whitened(table);
  const AmbientProjection projection(white);
  plan_ = std::make_unique<const Plan>(std::move(table), options, white, projection);
}
LikelihoodDecoder::~LikelihoodDecoder() = default;
LikelihoodDecoder::LikelihoodDecoder(LikelihoodDecoder&&) noexcept = default;
LikelihoodDecoder& LikelihoodDecoder::operator=(LikelihoodDecoder&&) noexcept = default;

const DecodingTable& LikelihoodDecoder::table() const { return plan_->table; }
const DecodeOptions& LikelihoodDecoder::options() const { return plan_->options; }

void LikelihoodDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                          double* depth_bin) const {
  std::vector<double> fall = plan_->work_space();
  for (std::int64_t i = 0; i < pixels; ++i)
    depth_bin[i] = plan_->decode_depth_bin(measurements + i * this->measurements(), fall);
}

void LikelihoodDecoder::decode_bins(const float* measurements, std::int64_t pixels,
                                    std::int32_t* bin) const {
  nearest_bins(*this, measurements, pixels, bin);
}

void LikelihoodDecoder::decode(const RawView& raw, const DecodedView& decoded,
                               const Progress& progress) const {
  plan_->decode(raw, nullptr, decoded, progress);
}

void LikelihoodDecoder::decode_within(const RawView& raw, const RangePart* parts,
                                      const DecodedView& decoded, const Progress& progress) const {
  plan_->decode(raw, parts, decoded, progress);
}

DepthImage LikelihoodDecoder::decode(const RawFrames& raw, int frame,
                                     const Progress& progress) const {
  return decoded_image(raw, frame, [&](const RawView& view, const DecodedView& decoded) {
    decode(view, decoded, progress);
  });
}

void LikelihoodDecoder::Plan::decode(const RawView& raw, const RangePart* parts,
                                     const DecodedView& decoded, const Progress& progress) const {
  constexpr std::int64_t block_pixels = usual_block_pixels / 16;
  const int count = table.measurements();
  decode_frame(
      MarkedRaw(raw, table.marking).view(), decoded, count, progress,
      [&](const RawBlock& block, const DecodedView& planes) {
        std::vector<double> fall = work_space();
        for (std::int64_t i = 0; i < block.pixels; ++i)
          decode_pixel(block.values + i * count, block.variance_share(i), block.noise_of(i),
                       parts ? parts + block.first + i : nullptr, static_cast<std::size_t>(i),
                       planes, fall);
      },
      block_pixels);
}

/// Reads electrons; returns false if a measurement is NaN or infinite.
bool LikelihoodDecoder::Plan::read(const float* raw, PerMeasurement& electrons) const {
  bool finite = true;
  for (int k = 0; k < table.measurements(); ++k) {
    electrons[static_cast<std::size_t>(k)] = scale.electrons(raw[k], k);
    finite = finite && std::isfinite(raw[k]);
  }
  if (!table.has_rows()) return finite;
  const PerMeasurement of_rows = electrons;
  for (int i = 0; i < table.measurements(); ++i) {
    double& white = electrons[static_cast<std::size_t>(i)] = 0.0;
    for (int k = 0; k < table.measurements(); ++k)
      white += table.whitening(i, k) * of_rows[static_cast<std::size_t>(k)];
  }
  return finite;
}

double LikelihoodDecoder::Plan::decode_depth_bin(const float* raw,
                                                 std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(raw, electrons)) return std::numeric_limits<double>::quiet_NaN();
  const MostLikely found = search.most_likely(search.model().pixel(electrons.data()), fall);
  return table.in_bins(search.depth_row(found));
}

void LikelihoodDecoder::Plan::decode_pixel(const float* raw, double variance_share,
                                           const NoiseRatios& noise, const RangePart* part,
                                           std::size_t at, const DecodedView& decoded,
                                           std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(raw, electrons)) return store_invalid(at, decoded);
  const LikelihoodPixel pixel = search.model().pixel(electrons.data(), variance_share);
  const MostLikely found = search.most_likely(pixel, fall, part);
  PixelDecoding decoding{search.depth_row(found), search.model().estimate(pixel, found.best)};
  if (decoding.estimate.signal_e_per_s > 0.0) {
    LikelihoodPixel of_lobes = pixel;
    of_lobes.variance_share *= noise.of_lobes;
    const std::optional<double> confidence = search.confidence(of_lobes, found, part);
    if (!confidence) return store_pixel(table, options, raw, {}, at, decoded);
    decoding.confidence = *confidence;
    if (decoded.residual || decoded.status)
      decoding.residual =
          residuals.residual(electrons.data(), decoding.estimate, Position::at(decoding.depth_row),
                             variance_share * noise.of_residual);
  }
  store_pixel(table, options, raw, decoding, at, decoded);
}

}  // namespace tofsmith

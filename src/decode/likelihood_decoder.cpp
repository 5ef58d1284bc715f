// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/likelihood_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "decode/depth_scores.hpp"
#include "decode/likelihood_model.hpp"
#include "decode/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

/// Costs that differ by less, per unit where they are large, tie: the lowest depth wins.
constexpr double cost_tie = 1e-9;
/// Peaks are followed whose weighted squares are at most `squares_ratio` times those of the best
/// peak plus `squares_lead`: weights come from one estimate for all.
constexpr double squares_ratio = 2.0, squares_lead = 30.0;
constexpr std::size_t most_peaks = 16;

using PerMeasurement = std::array<double, max_measurements>;

/// A peak over bins, and the weighted squares it leaves on the better chord beside it.
struct Peak {
  std::int32_t bin = 0;
  double squares = 0.0;
};

/// The most promising peaks of a pixel, best first.
class Peaks {
 public:
  void add(const Peak& peak) {
    std::size_t at = count_;
    while (at > 0 && peaks_[at - 1].squares > peak.squares) --at;
    if (at == most_peaks) return;
    count_ = std::min(count_ + 1, most_peaks);
    std::copy_backward(peaks_.begin() + at, peaks_.begin() + count_ - 1, peaks_.begin() + count_);
    peaks_[at] = peak;
  }
  const Peak* begin() const { return peaks_.data(); }
  const Peak* end() const { return peaks_.data() + count_; }

 private:
  std::array<Peak, most_peaks> peaks_{};
  std::size_t count_ = 0;
};

/// The most likely light of a pixel, and the followed peaks it won against.
struct Search {
  PerMeasurement weight;
  ChordFit best;
  std::array<ChordFit, most_peaks> followed;
  std::size_t count = 0;
};

}  // namespace

struct LikelihoodDecoder::Plan {
  Plan(DecodingTable table_, const DecodeOptions& options_, const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        scale(table),
        scores(projection),
        correlation(table, projection),
        likelihood(table, projection),
        directions(projection) {}

  DecodingTable table;
  DecodeOptions options;
  RawScale scale;
  DepthScores scores;
  PixelModel correlation;
  LikelihoodModel likelihood;
  DirectionTable directions;

  bool read(const float* raw, PerMeasurement& electrons) const;
  double depth_bin(const ChordFit& fit) const { return fit.position().in_bins(table.samples()); }
  std::vector<double> work_space() const {
    return std::vector<double>(static_cast<std::size_t>(table.samples()));
  }
  bool estimate_weights(const double* electrons, Search& search) const;
  double squares_beside(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  Peaks peaks(const LikelihoodPixel& pixel, const PerMeasurement& weight,
              const std::vector<double>& fall) const;
  Search search(const LikelihoodPixel& pixel, std::vector<double>& fall) const;
  double decode_depth_bin(const float* raw, std::vector<double>& fall) const;
  double confidence(const LikelihoodPixel& pixel, const Search& search,
                    const std::vector<double>& fall) const;
  void decode_pixel(const float* raw, std::size_t at, const DecodedView& decoded,
                    std::vector<double>& fall) const;
};

LikelihoodDecoder::LikelihoodDecoder(DecodingTable table, const DecodeOptions& options) {
  options.validate();
  table.validate();
  const AmbientProjection projection(table);
  plan_ = std::make_unique<const Plan>(std::move(table), options, projection);
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
  std::vector<double> fall = plan_->work_space();
  for (std::int64_t i = 0; i < pixels; ++i) {
    const double position = plan_->decode_depth_bin(measurements + i * this->measurements(), fall);
    bin[i] =
        std::isnan(position) ? -1 : static_cast<std::int32_t>(std::lround(position)) % samples();
  }
}

void LikelihoodDecoder::decode(const RawView& raw, const DecodedView& decoded,
                               const Progress& progress) const {
  decode_frame(raw, decoded, measurements(), progress,
               [&](const float* values, std::int64_t pixels, const DecodedView& block) {
                 std::vector<double> fall = plan_->work_space();
                 for (std::int64_t i = 0; i < pixels; ++i)
                   plan_->decode_pixel(values + i * measurements(), static_cast<std::size_t>(i),
                                       block, fall);
               });
}

DepthImage LikelihoodDecoder::decode(const RawFrames& raw, int frame,
                                     const Progress& progress) const {
  return decoded_image(raw, frame, [&](const RawView& view, const DecodedView& decoded) {
    decode(view, decoded, progress);
  });
}

/// False where a measurement is NaN or infinite.
bool LikelihoodDecoder::Plan::read(const float* raw, PerMeasurement& electrons) const {
  bool finite = true;
  for (int k = 0; k < table.measurements(); ++k) {
    electrons[static_cast<std::size_t>(k)] = scale.electrons(raw[k], k);
    finite = finite && std::isfinite(raw[k]);
  }
  return finite;
}

/// NaN where a measurement is NaN or infinite.
double LikelihoodDecoder::Plan::decode_depth_bin(const float* raw,
                                                 std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(raw, electrons)) return std::numeric_limits<double>::quiet_NaN();
  return depth_bin(search(likelihood.pixel(electrons.data()), fall).best);
}

/// Inverse variances of the measurements at the estimate of zero-mean normalized cross-correlation.
/// Any depth that explains the pixel has nearly the same ones. False if ambient light alone
/// explains the pixel, which is then all there is.
bool LikelihoodDecoder::Plan::estimate_weights(const double* electrons, Search& search) const {
  PerMeasurement plane, variance_e2;
  correlation.project(electrons, plane.data());
  const std::int32_t bin = scores.best_correlation(plane.data());
  const PixelEstimate estimate = correlation.estimate(
      electrons, plane.data(), correlation.refine(plane.data(), bin), variance_e2.data());
  for (int k = 0; k < table.measurements(); ++k)
    search.weight[static_cast<std::size_t>(k)] = 1.0 / variance_e2[static_cast<std::size_t>(k)];
  search.best.light[2] = std::max(0.0, estimate.ambient_e_per_s);
  return std::any_of(plane.begin(), plane.begin() + correlation.rank(),
                     [](double value) { return value != 0.0; });
}

double LikelihoodDecoder::Plan::squares_beside(const LikelihoodPixel& pixel, std::int32_t bin,
                                               const double* weight) const {
  const std::int32_t before = bin > 0 ? bin - 1 : table.samples() - 1;
  double whole = 0.0;
  for (int k = 0; k < table.measurements(); ++k)
    whole += weight[k] * pixel.electrons[k] * pixel.electrons[k];
  return whole + 2 * std::min(likelihood.least_squares(pixel, before, weight).value,
                              likelihood.least_squares(pixel, bin, weight).value);
}

Peaks LikelihoodDecoder::Plan::peaks(const LikelihoodPixel& pixel, const PerMeasurement& weight,
                                     const std::vector<double>& fall) const {
  Peaks found;
  const std::size_t last = fall.size() - 1;
  for (std::size_t n = 0; n <= last; ++n) {
    const double before = fall[n > 0 ? n - 1 : last], after = fall[n < last ? n + 1 : 0];
    const bool rises = n > 0 ? fall[n] > before : fall[n] >= before;
    if (!rises || fall[n] < after) continue;
    const auto bin = static_cast<std::int32_t>(n);
    found.add({bin, squares_beside(pixel, bin, weight.data())});
  }
  return found;
}

Search LikelihoodDecoder::Plan::search(const LikelihoodPixel& pixel,
                                       std::vector<double>& fall) const {
  Search result;
  if (!estimate_weights(pixel.electrons, result)) return result;
  scores.weighted_fall(pixel.electrons, result.weight.data(), fall.data());

  const Peaks found = peaks(pixel, result.weight, fall);
  const double most_squares = squares_ratio * std::max(found.begin()->squares, 0.0) + squares_lead;
  for (const Peak& peak : found) {
    if (peak.squares > most_squares) break;
    const ChordFit fit = likelihood.fit_around(pixel, peak.bin, result.weight.data());
    const double tie = cost_tie * std::max(1.0, std::abs(result.best.cost));
    const bool is_first = result.count == 0;
    const bool is_lower = fit.cost < result.best.cost - tie;
    const bool ties = fit.cost <= result.best.cost + tie;
    if (is_first || is_lower || (ties && depth_bin(fit) < depth_bin(result.best)))
      result.best = fit;
    result.followed[result.count++] = fit;
  }
  result.best = likelihood.fit_near(pixel, result.best, result.weight.data());
  return result;
}

/// Against the best followed peak outside the main lobe, and the best bin there.
double LikelihoodDecoder::Plan::confidence(const LikelihoodPixel& pixel, const Search& search,
                                           const std::vector<double>& fall) const {
  const std::int32_t samples = table.samples();
  const auto nearest = static_cast<std::int32_t>(std::lround(depth_bin(search.best))) % samples;
  const Lobe lobe = directions.main_lobe(nearest);
  if (lobe.end - lobe.begin >= samples) return 1.0;

  std::int32_t rival = lobe.end % samples;
  for (std::int32_t n = lobe.end; n < lobe.begin + samples; ++n)
    if (fall[static_cast<std::size_t>(n % samples)] > fall[static_cast<std::size_t>(rival)])
      rival = n % samples;
  double rival_cost = likelihood.fit(pixel, rival, search.weight.data()).cost;
  for (std::size_t i = 0; i < search.count; ++i) {
    const double above = wrap(depth_bin(search.followed[i]) - lobe.begin, samples);
    if (above > lobe.end - 1 - lobe.begin)
      rival_cost = std::min(rival_cost, search.followed[i].cost);
  }
  return 1.0 / (1.0 + std::exp(-0.5 * std::max(rival_cost - search.best.cost, 0.0)));
}

void LikelihoodDecoder::Plan::decode_pixel(const float* raw, std::size_t at,
                                           const DecodedView& decoded,
                                           std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(raw, electrons)) return store_invalid(at, decoded);
  const LikelihoodPixel pixel = likelihood.pixel(electrons.data());
  const Search found = search(pixel, fall);
  PixelDecoding decoding{depth_bin(found.best), likelihood.estimate(pixel, found.best)};
  if (decoding.estimate.signal_e_per_s > 0.0) decoding.confidence = confidence(pixel, found, fall);
  store_pixel(table, options, raw, decoding, at, decoded);
}

}  // namespace tofsmith

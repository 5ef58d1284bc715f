// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/likelihood_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/likelihood/likelihood_model.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_kernel.hpp"
#include "decode/raw_scale.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

/// Computes how well each bin explains a pixel.
class DepthScores {
 public:
  explicit DepthScores(const AmbientProjection& projection);

  int samples() const { return static_cast<int>(gated_.cols()); }

  /// Returns the lowest bin with the best zero-mean normalized cross-correlation, up to rounding.
  /// @param plane  pixel without the ambient component, in the subspace (rank)
  std::int32_t best_correlation(const double* plane) const;

  /// Computes the decrease of sum_i weight_i y_i^2 by signal >= 0 of each bin and ambient light >=
  /// 0.
  /// @param electrons  without dark electrons (K)
  /// @param fall       result (N)
  void weighted_fall(const double* electrons, const double* weight, double* fall) const;

 private:
  RowMajorMatrix directions_;  // p / |p| (rank, N); 0 without contrast
  RowMajorMatrix gated_;       // x (K, N)
  Eigen::VectorXd ambient_;    // a (K)
};

inline constexpr std::size_t max_peaks = 16;

struct MostLikely {
  std::array<double, max_measurements> weight;  ///< estimated inverse variances [1/e^2]
  ChordFit best;
  double moved = 0.0;  ///< from the best point of the chord to that of the curve [rows]
};

/// Finds the global maximum of the likelihood. It is missed if it is not a peak with the initial
/// weights: with ten measurements in dim light and exposures of 1 : 14, in fewer than 0.1 % of
/// pixels.
class LikelihoodSearch {
 public:
  LikelihoodSearch(const DecodingTable& table, const AmbientProjection& projection);

  const LikelihoodModel& model() const { return model_; }
  double depth_row(const ChordFit& fit) const { return fit.position().in_rows(scores_.samples()); }
  double depth_row(const MostLikely& found) const;

  /// Returns no signal if ambient light alone explains the pixel, or if no peak lies within
  /// `within`.
  /// @param fall    working memory (N); returns DepthScores::weighted_fall()
  /// @param within  part in which the depth must lie; null: anywhere
  MostLikely most_likely(const LikelihoodPixel& pixel, std::vector<double>& fall,
                         const RangePart* within = nullptr) const;
  /// Returns LobePosterior::confidence() of the most likely depth.
  std::optional<double> confidence(const LikelihoodPixel& pixel, const MostLikely& found,
                                   const RangePart* within) const;

 private:
  struct Peak;
  class Peaks;
  bool estimate_weights(const LikelihoodPixel& pixel, MostLikely& result) const;
  double squares_beside(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  double moved_to_curve(const LikelihoodPixel& pixel, const ChordFit& best, const double* weight,
                        const std::vector<double>& fall) const;
  bool contains(const RangePart* within, double row) const;
  Peaks peaks(const LikelihoodPixel& pixel, const double* weight, const std::vector<double>& fall,
              const RangePart* within) const;

  DepthScores scores_;
  PixelModel correlation_;
  LikelihoodModel model_;
  bool is_smooth_;  // the curve between rows is known and differs from the chords
  LobePosterior posterior_;
};

namespace {

constexpr int bins_per_block = 64;
/// Squared sine of the angle between signal and ambient light that counts as 0.
constexpr double parallel_light = 1e-13;

/// Costs that differ by less are ties; the lowest depth wins.
constexpr double cost_tie = 1e-9;
/// Peaks are refined if their weighted squares are at most `squares_ratio` times the best plus
/// `squares_lead`.
constexpr double squares_ratio = 2.0, squares_lead = 30.0;

}  // namespace

DepthScores::DepthScores(const AmbientProjection& projection)
    : directions_(projection.curve.rowwise().normalized().transpose()),
      gated_(projection.gated.transpose()),
      ambient_(projection.ambient) {}

std::int32_t DepthScores::best_correlation(const double* plane) const {
  double best = -1.0;
  std::int32_t best_bin = -1;
  std::array<double, bins_per_block> score;
  for (int first = 0; first < samples(); first += bins_per_block) {
    const int count = std::min(bins_per_block, samples() - first);
    score.fill(0.0);
    for (Eigen::Index j = 0; j < directions_.rows(); ++j) {
      const double* direction = directions_.row(j).data() + first;
      for (int i = 0; i < count; ++i) score[static_cast<std::size_t>(i)] += plane[j] * direction[i];
    }
    for (int i = 0; i < count; ++i)
      if (best_bin < 0 || score[static_cast<std::size_t>(i)] > best) {
        best = score[static_cast<std::size_t>(i)];
        best_bin = first + i;
      }
  }
  return best_bin;
}

void DepthScores::weighted_fall(const double* electrons, const double* weight, double* fall) const {
  std::array<double, bins_per_block> xx, xa, xy;
  double aa = 0.0, ay = 0.0;
  for (Eigen::Index k = 0; k < ambient_.size(); ++k) {
    aa += weight[k] * ambient_[k] * ambient_[k];
    ay += weight[k] * ambient_[k] * electrons[k];
  }
  const double ambient_alone = ay > 0.0 ? ay * ay / aa : 0.0;
  for (int first = 0; first < samples(); first += bins_per_block) {
    const int count = std::min(bins_per_block, samples() - first);
    xx.fill(0.0), xa.fill(0.0), xy.fill(0.0);
    for (Eigen::Index k = 0; k < ambient_.size(); ++k) {
      const double* x = gated_.row(k).data() + first;
      const double by_a = weight[k] * ambient_[k], by_y = weight[k] * electrons[k];
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        xx[at] += weight[k] * x[i] * x[i];
        xa[at] += by_a * x[i];
        xy[at] += by_y * x[i];
      }
    }
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double signal = xy[at] * aa - ay * xa[at], ambient = ay * xx[at] - xy[at] * xa[at];
      const double determinant = xx[at] * aa - xa[at] * xa[at];
      const double signal_alone = xy[at] > 0.0 ? xy[at] * xy[at] / xx[at] : 0.0;
      const bool both = signal > 0.0 && ambient > 0.0 && determinant > parallel_light * xx[at] * aa;
      fall[first + i] = both ? (signal * xy[at] + ambient * ay) / determinant
                             : std::max(signal_alone, ambient_alone);
    }
  }
}

/// A peak over bins, and the weighted squares that the better adjacent chord leaves.
struct LikelihoodSearch::Peak {
  std::int32_t bin = 0;
  double squares = 0.0;
};

class LikelihoodSearch::Peaks {
 public:
  void add(const Peak& peak) {
    std::size_t at = count_;
    while (at > 0 && peaks_[at - 1].squares > peak.squares) --at;
    if (at == max_peaks) return;
    count_ = std::min(count_ + 1, max_peaks);
    std::copy_backward(peaks_.begin() + at, peaks_.begin() + count_ - 1, peaks_.begin() + count_);
    peaks_[at] = peak;
  }
  const Peak* begin() const { return peaks_.data(); }
  const Peak* end() const { return peaks_.data() + count_; }

 private:
  std::array<Peak, max_peaks> peaks_{};
  std::size_t count_ = 0;
};

LikelihoodSearch::LikelihoodSearch(const DecodingTable& table, const AmbientProjection& projection)
    : scores_(projection),
      correlation_(table, projection),
      model_(table, projection),
      is_smooth_(finely_sampled_curve(projection.curve).has_value()),
      posterior_(table, projection) {}

double LikelihoodSearch::depth_row(const MostLikely& found) const {
  return wrap(depth_row(found.best) + found.moved, scores_.samples());
}

/// Returns the distance from the best point on the chord to the curve. If the contrast of some
/// measurements differs from the table's, that point moves towards the middle or the ends of the
/// chord. The weighted squares that five rows explain contain the curvature of the pixel itself.
double LikelihoodSearch::moved_to_curve(const LikelihoodPixel& pixel, const ChordFit& best,
                                        const double* weight,
                                        const std::vector<double>& fall) const {
  const std::int32_t samples = scores_.samples();
  const auto at = [&](std::int32_t row) {
    return std::sqrt(std::max(0.0, fall[static_cast<std::size_t>((row + samples) % samples)]));
  };
  std::int32_t row = nearest_bin(depth_row(best), samples);
  constexpr double max_squares_per_measurement = 10.0;
  if (squares_beside(pixel, row, weight) <=
      max_squares_per_measurement * correlation_.measurements())
    return 0.0;
  for (int step = 0; step < 2 && std::max(at(row - 1), at(row + 1)) > at(row); ++step)
    row = (row + (at(row + 1) > at(row - 1) ? 1 : samples - 1)) % samples;

  // Newton steps find the peak of the quartic through five rows.
  const double f0 = at(row), f1 = at(row + 1), b1 = at(row - 1), f2 = at(row + 2), b2 = at(row - 2);
  const double first = (8.0 * (f1 - b1) - (f2 - b2)) / 12.0;
  const double second = (16.0 * (f1 + b1) - (f2 + b2) - 30.0 * f0) / 12.0;
  const double third = 0.5 * (f2 - b2) - (f1 - b1);
  const double fourth = f2 + b2 - 4.0 * (f1 + b1) + 6.0 * f0;
  if (!(second < 0.0)) return 0.0;
  double peak = 0.0;
  for (int step = 0; step < 4; ++step) {
    const double slope = first + peak * (second + peak * (third / 2.0 + peak * fourth / 6.0));
    peak = std::clamp(peak - slope / second, -1.0, 1.0);
  }

  return circular_difference(row + peak, depth_row(best), samples);
}

/// Computes the inverse variances at the estimate of zero-mean normalized cross-correlation.
/// Returns false if ambient light alone explains the pixel.
bool LikelihoodSearch::estimate_weights(const LikelihoodPixel& pixel, MostLikely& result) const {
  std::array<double, max_measurements> plane, variance_e2;
  correlation_.project(pixel.electrons, plane.data());
  const std::int32_t bin = scores_.best_correlation(plane.data());
  const PixelEstimate estimate =
      correlation_.estimate(pixel.electrons, plane.data(), correlation_.refine(plane.data(), bin),
                            variance_e2.data(), pixel.variance_share);
  for (int k = 0; k < correlation_.measurements(); ++k)
    result.weight[static_cast<std::size_t>(k)] = 1.0 / variance_e2[static_cast<std::size_t>(k)];
  result.best.light[2] = std::max(0.0, estimate.ambient_e_per_s);
  return std::any_of(plane.begin(), plane.begin() + correlation_.rank(),
                     [](double value) { return value != 0.0; });
}

double LikelihoodSearch::squares_beside(const LikelihoodPixel& pixel, std::int32_t bin,
                                        const double* weight) const {
  const std::int32_t before = bin > 0 ? bin - 1 : scores_.samples() - 1;
  double whole = 0.0;
  for (int k = 0; k < correlation_.measurements(); ++k)
    whole += weight[k] * pixel.electrons[k] * pixel.electrons[k];
  return whole + 2 * std::min(model_.least_squares(pixel, before, weight).value,
                              model_.least_squares(pixel, bin, weight).value);
}

bool LikelihoodSearch::contains(const RangePart* within, double row) const {
  return !within || within->contains(row / scores_.samples());
}

LikelihoodSearch::Peaks LikelihoodSearch::peaks(const LikelihoodPixel& pixel, const double* weight,
                                                const std::vector<double>& fall,
                                                const RangePart* within) const {
  Peaks found;
  const std::size_t last = fall.size() - 1;
  for (std::size_t n = 0; n <= last; ++n) {
    const double before = fall[n > 0 ? n - 1 : last], after = fall[n < last ? n + 1 : 0];
    const bool rises = n > 0 ? fall[n] > before : fall[n] >= before;
    if (!rises || fall[n] < after) continue;
    const auto bin = static_cast<std::int32_t>(n);
    // A peak is up to one row from its most likely depth.
    if (!contains(within, bin) && !contains(within, bin - 1) && !contains(within, bin + 1))
      continue;
    found.add({bin, squares_beside(pixel, bin, weight)});
  }
  return found;
}

MostLikely LikelihoodSearch::most_likely(const LikelihoodPixel& pixel, std::vector<double>& fall,
                                         const RangePart* within) const {
  MostLikely result;
  if (!estimate_weights(pixel, result)) return result;
  scores_.weighted_fall(pixel.electrons, result.weight.data(), fall.data());

  const Peaks found = peaks(pixel, result.weight.data(), fall, within);
  const double max_squares = squares_ratio * std::max(found.begin()->squares, 0.0) + squares_lead;
  bool is_first = true;
  for (const Peak& peak : found) {
    if (peak.squares > max_squares) break;
    const ChordFit fit = model_.fit_around(pixel, peak.bin, result.weight.data());
    if (!contains(within, depth_row(fit))) continue;
    const double tie = cost_tie * std::max(1.0, std::abs(result.best.cost));
    const bool is_lower = fit.cost < result.best.cost - tie;
    const bool ties = fit.cost <= result.best.cost + tie;
    if (is_first || is_lower || (ties && depth_row(fit) < depth_row(result.best)))
      result.best = fit;
    is_first = false;
  }
  if (is_first) return result;
  result.best = model_.fit_near(pixel, result.best, result.weight.data());
  if (is_smooth_) result.moved = moved_to_curve(pixel, result.best, result.weight.data(), fall);
  return result;
}

std::optional<double> LikelihoodSearch::confidence(const LikelihoodPixel& pixel,
                                                   const MostLikely& found,
                                                   const RangePart* within) const {
  std::array<double, max_measurements> plane, variance_e2;
  correlation_.project(pixel.electrons, plane.data());
  for (int k = 0; k < correlation_.measurements(); ++k)
    variance_e2[static_cast<std::size_t>(k)] = 1.0 / found.weight[static_cast<std::size_t>(k)];
  return posterior_.confidence(plane.data(), variance_e2.data(),
                               nearest_bin(depth_row(found), scores_.samples()), within);
}

struct LikelihoodDecoder::Plan {
  /// @param white  whitened(table_)
  Plan(DecodingTable table_, const DecodeOptions& options_, const DecodingTable& white,
       const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        scale(table),
        search(white, projection),
        residuals(white, projection, options) {}

  using PerMeasurement = std::array<double, max_measurements>;

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
  void decode_pixel(const PixelToDecode& pixel, const DecodedView& decoded,
                    std::vector<double>& fall) const;
};

LikelihoodDecoder::LikelihoodDecoder(DecodingTable table, const DecodeOptions& options) {
  options.validate();
  table.validate();
  require(table.decoder == RowDecoder::whitened, "sensor.decoder", "plain",
          "must be \"whitened\" for ml, which takes the correlation of the noise into account");
  const DecodingTable white = whitened(table);
  const AmbientProjection projection(white);
  plan_ = make_hidden<const Plan>(std::move(table), options, white, projection);
}

const DecodingTable& LikelihoodDecoder::table() const { return plan_->table; }

void LikelihoodDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                          double* depth_bin) const {
  std::vector<double> fall = plan_->work_space();
  const int count = this->measurements();
  for (std::int64_t i = 0; i < pixels; ++i)
    depth_bin[i] = plan_->decode_depth_bin(measurements + i * count, fall);
}

void LikelihoodDecoder::decode_pixels(const RawView& raw, const RangePart* parts,
                                      const DecodedView& decoded, const Progress& progress) const {
  constexpr std::int64_t block_pixels = usual_block_pixels / 16;
  const int count = measurements();
  decode_frame(
      MarkedRaw(raw, table().marking).view(), decoded, count, progress,
      [&](const RawBlock& block, const DecodedView& planes) {
        std::vector<double> fall = plan_->work_space();
        for (std::int64_t i = 0; i < block.pixels; ++i)
          plan_->decode_pixel(block.pixel(i, count, parts), planes, fall);
      },
      block_pixels);
}

/// Reads electrons; returns false if a measurement is NaN or infinite.
bool LikelihoodDecoder::Plan::read(const float* raw, PerMeasurement& electrons) const {
  const bool is_finite = scale.read(raw, electrons.data());
  if (!table.has_rows()) return is_finite;
  const PerMeasurement of_rows = electrons;
  for (int i = 0; i < table.measurements(); ++i) {
    double& white = electrons[static_cast<std::size_t>(i)] = 0.0;
    for (int k = 0; k < table.measurements(); ++k)
      white += table.whitening(i, k) * of_rows[static_cast<std::size_t>(k)];
  }
  return is_finite;
}

double LikelihoodDecoder::Plan::decode_depth_bin(const float* raw,
                                                 std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(raw, electrons)) return std::numeric_limits<double>::quiet_NaN();
  const MostLikely found = search.most_likely(search.model().pixel(electrons.data()), fall);
  return table.in_bins(search.depth_row(found));
}

void LikelihoodDecoder::Plan::decode_pixel(const PixelToDecode& pixel, const DecodedView& decoded,
                                           std::vector<double>& fall) const {
  PerMeasurement electrons;
  if (!read(pixel.raw, electrons)) return store_invalid(pixel.at, decoded);
  const LikelihoodPixel likely = search.model().pixel(electrons.data(), pixel.variance_share);
  const MostLikely found = search.most_likely(likely, fall, pixel.part);
  PixelDecoding decoding{search.depth_row(found), search.model().estimate(likely, found.best)};
  if (decoding.estimate.signal_e_per_s > 0.0) {
    LikelihoodPixel of_lobes = likely;
    of_lobes.variance_share *= pixel.noise.of_lobes;
    decoding.set_confidence(search.confidence(of_lobes, found, pixel.part));
  }
  store_pixel(table, options, residuals, electrons.data(), decoding, pixel, decoded);
}

}  // namespace tofsmith

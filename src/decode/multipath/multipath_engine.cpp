// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/multipath_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "core/shared/special_functions.hpp"
#include "decode/output/output_kernel.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int delays_taken = 18, ratios_taken = 8;
constexpr double reach_m = 1.7;

/// Measurements and rows of the curve from `first` on, with white noise and without ambient light.
struct WhitePixel {
  Eigen::VectorXd target;
  RowMajorMatrix direct, behind;  // (rows, span); `behind` only for a tail

  WhitePixel(const MultipathCurve& curve, const PixelGroup& pixels, int lane, int first, int rows) {
    const int dims = curve.dims(), from = curve.sees_ambient ? 1 : 0;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(dims, dims);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(dims);
    for (int k = 0; k < curve.measurements; ++k) {
      const Eigen::VectorXd column =
          Eigen::Map<const Eigen::VectorXf>(curve.basis.data() + k * dims, dims).cast<double>();
      const double weight = 1.0 / pixels.variance_e2[k][lane];
      information += weight * column * column.transpose();
      sum += weight * pixels.electrons[k][lane] * column;
    }
    const Eigen::MatrixXd factor = cholesky_factor(information);
    target = factor.triangularView<Eigen::Lower>().solve(sum).tail(curve.span);
    const Eigen::MatrixXd plane = factor.block(from, from, curve.span, curve.span);
    const auto white = [&](const std::vector<float>& table) {
      RowMajorMatrix values(rows, curve.span);
      for (int i = 0; i < rows; ++i) {
        const int at = ((first + i) % curve.points + curve.points) % curve.points;
        values.row(i) =
            Eigen::Map<const Eigen::RowVectorXf>(table.data() + at * curve.span, curve.span)
                .cast<double>() *
            plane;
      }
      return values;
    };
    direct = white(curve.fine);
    if (!curve.tail.empty()) behind = white(curve.tail);
  }
};

/// Half of the squares that a signal explains.
double explained(double along, double own) {
  return along > 0.0 && own > 0.0 ? 0.5 * along * along / own : 0.0;
}

const DecodingTable& checked(const DecodingTable& table, const MultipathOptions& options) {
  table.validate();
  require_exposures(table, "multipath decoding");
  options.validate(table.range_m);
  return table;
}

double on_chord(const RowMajorMatrix& table, double row, int k) {
  const auto from = std::min(static_cast<Eigen::Index>(row), table.rows() - 1);
  const double t = row - static_cast<double>(from);
  return (1 - t) * table(from, k) + t * table((from + 1) % table.rows(), k);
}

}  // namespace

ReturnPosterior::ReturnPosterior(const MultipathCurve& curve, const ReturnPrior& prior,
                                 double range_m, const DelayBounds& delays)
    : single_probability_(prior.single_probability),
      reach_(static_cast<int>(std::min(0.45, reach_m / range_m) * curve.points)) {
  const double points_per_m = curve.points / range_m;
  for (int i = 0; i < (curve.tail.empty() ? delays_taken : 1); ++i) {
    const double delay_m = -prior.mean_delay_m * std::log1p(-(i + 0.5) / delays_taken);
    delay_.push_back(curve.tail.empty()
                         ? static_cast<int>(std::lround(std::min(
                               points_per_m * delay_m, static_cast<double>(delays.longest))))
                         : 0);
  }
  for (int i = 0; i < ratios_taken; ++i)
    ratio_.push_back(prior.max_ratio * (i + 0.5) / ratios_taken);
}

DepthPosterior ReturnPosterior::around(const MultipathCurve& curve, const PixelGroup& pixels,
                                       int lane, double position) const {
  const int first = static_cast<int>(std::lround(position)) - reach_, places = 2 * reach_ + 1;
  const int rows = places + *std::max_element(delay_.begin(), delay_.end());
  const WhitePixel white(curve, pixels, lane, first, rows);
  const RowMajorMatrix& behind = curve.tail.empty() ? white.direct : white.behind;
  const Eigen::VectorXd along = white.direct * white.target;
  const Eigen::VectorXd own = white.direct.rowwise().squaredNorm();
  const Eigen::VectorXd later_along = behind * white.target;
  const Eigen::VectorXd later_own = behind.rowwise().squaredNorm();

  const double most = 0.5 * white.target.squaredNorm();
  const double per_pair =
      (1.0 - single_probability_) / static_cast<double>(delay_.size() * ratio_.size());
  std::vector<double> density(static_cast<std::size_t>(places));
  double whole = 0.0;
  for (int z = 0; z < places; ++z) {
    double sum = single_probability_ * std::exp(explained(along[z], own[z]) - most);
    for (const int delay : delay_) {
      const double between = white.direct.row(z).dot(behind.row(z + delay));
      for (const double r : ratio_)
        sum +=
            per_pair * std::exp(explained(along[z] + r * later_along[z + delay],
                                          own[z] + 2 * r * between + r * r * later_own[z + delay]) -
                                most);
    }
    density[static_cast<std::size_t>(z)] = sum;
    whole += sum;
  }
  if (!(whole > 0.0)) return {position, 0.0};
  double before = 0.0, mean = 0.0, square = 0.0, median = 0.0;
  bool passed = false;
  for (int z = 0; z < places; ++z) {
    const double here = density[static_cast<std::size_t>(z)] / whole;
    if (!passed && before + here >= 0.5) {
      median = z - 0.5 + (0.5 - before) / here;
      passed = true;
    }
    before += here;
    mean += here * z;
    square += here * z * z;
  }
  const double at = first + median;
  return {at - curve.points * std::floor(at / curve.points),
          std::sqrt(std::max(square - mean * mean, 0.0))};
}

struct MultipathEngine::Queue {
  std::array<std::int64_t, pixels_per_group> pixel{};
  std::array<float, pixels_per_group> depth_m{};
  int count = 0;
};

MultipathEngine::MultipathEngine(DecodingTable table, const MultipathOptions& options,
                                 MultipathKind later)
    : MultipathEngine(checked(table, options), options, later, AmbientProjection(table)) {}

MultipathEngine::MultipathEngine(DecodingTable table, const MultipathOptions& options,
                                 MultipathKind later, const AmbientProjection& projection)
    : options_(options),
      kind_(later),
      single_(std::move(table), options.status_thresholds),
      scale_(single_.table()),
      noise_(single_.table()),
      has_own_shot_noise_(single_.table().shot_correlation.size() > 0),
      ambient_(projection.ambient),
      gated_(projection.gated),
      curve_(single_.table(), projection, later == MultipathKind::tail ? options.tail_m : 0.0) {
  require(missing_support(projection, later));
  const DecodingTable& known = single_.table();
  const double points_per_m = curve_.points / known.range_m;
  const double longest_m = options.longest_delay_m.value_or(known.range_m / 3);
  delays_ = {static_cast<float>(points_per_m * options.shortest_delay_m),
             static_cast<float>(points_per_m * longest_m)};
  if (later == MultipathKind::tail)
    gated_tail_ = exponential_average(gated_, options.tail_m / known.row_m());
  const double freedom = curve_.span - 2;
  unexplained_chi2_ =
      static_cast<float>(freedom + std::sqrt(options.threshold) * std::sqrt(2 * freedom));
  // Unknowns: depth, both signals and, for a second return, its delay.
  freedom_ = curve_.span - (later == MultipathKind::tail ? 3 : 4);
  const double false_alarm_rate = options.status_thresholds.false_alarm_rate;
  if (freedom_ > 0 && false_alarm_rate > 0.0)
    consistent_chi2_ = chi_square_quantile_of_tail(false_alarm_rate, freedom_);
  if (options.prior) posterior_.emplace(curve_, *options.prior, known.range_m, delays_);
}

void MultipathEngine::decode(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                             const Progress& progress) const {
  decode_frame(MarkedRaw(raw, table().marking).view(), decoded, table().measurements(), progress,
               [&](const RawBlock& block, const DecodedView& planes) {
                 decode_block(block, parts ? parts + block.first : nullptr, planes);
               });
}

void MultipathEngine::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                        double* depth_bin) const {
  constexpr std::int64_t most = 16384;
  std::vector<float> depth_m(static_cast<std::size_t>(std::min(pixels, most)));
  for (std::int64_t first = 0; first < pixels; first += most) {
    const std::int64_t count = std::min(most, pixels - first);
    const float* raw = measurements + first * table().measurements();
    decode_block({raw, count}, nullptr, {.depth_m = depth_m.data()});
    std::transform(depth_m.begin(), depth_m.begin() + count, depth_bin + first,
                   [&](float depth) { return depth / table().bin_m(); });
  }
}

/// Loads one pixel into a lane. Its noise follows from the measured light or, if buckets are
/// subtracted, from the single return.
void MultipathEngine::load(const RawBlock& raw, std::int64_t pixel, float depth_m, int lane,
                           PixelGroup& group) const {
  const int k_count = table().measurements();
  const bool is_valid = std::isfinite(depth_m);
  const double row = is_valid ? depth_m / table().row_m() : 0.0;
  const float* const values = raw.values + pixel * k_count;
  const double share = raw.variance_share(pixel);
  double along = 0.0, own = 0.0;
  for (int k = 0; k < k_count; ++k) {
    const double electrons = is_valid ? scale_.electrons(values[k], k) : 0.0;
    group.electrons[k][lane] = static_cast<float>(electrons);
    group.variance_e2[k][lane] = static_cast<float>(
        share * std::max(min_variance_e2, std::max(electrons, 0.0) + noise_.floor_variance_e2[k]));
    if (!has_own_shot_noise_) continue;
    const double x = on_chord(gated_, row, k);
    along += x * electrons;
    own += x * x;
  }
  group.guess[lane] = static_cast<float>(row * curve_.points_per_row);
  if (!has_own_shot_noise_) return;
  const double signal = own > 0.0 ? std::max(along / own, 0.0) : 0.0;
  for (int k = 0; k < k_count; ++k)
    group.variance_e2[k][lane] = static_cast<float>(
        share * std::max(min_variance_e2, signal * on_chord(noise_.shot_gated, row, k) +
                                              noise_.floor_variance_e2[k]));
}

void MultipathEngine::load_part(const RangePart& part, int lane, PixelGroup& group) const {
  group.excluded_from[lane] = static_cast<float>((part.begin + part.length) * curve_.points);
  group.excluded_length[lane] =
      static_cast<float>(std::max(1.0 - part.length, 0.0) * curve_.points);
}

/// @param position  [fine points]
bool MultipathEngine::is_within(const PixelGroup& group, double position, int lane) const {
  const double after = (position - group.excluded_from[lane]) / curve_.points;
  return (after - std::floor(after)) * curve_.points >= group.excluded_length[lane];
}

void MultipathEngine::decode_block(const RawBlock& raw, const RangePart* parts,
                                   const DecodedView& decoded) const {
  const std::int64_t pixels = raw.pixels;
  DecodedView planes = decoded;
  std::vector<float> own_depth;
  if (!planes.depth_m) {
    own_depth.resize(static_cast<std::size_t>(pixels));
    planes.depth_m = own_depth.data();
  }
  const RawView view = marked_view(
      RawView::interleaved(raw.values, 1, static_cast<int>(pixels), table().measurements()),
      raw.averaged, raw.noise);
  if (parts)
    single_.decode_within(view, parts, planes);
  else
    single_.decode(view, planes);

  PixelGroup group;
  SingleFits fits;
  Queue queue;
  for (std::int64_t first = 0; first < pixels; first += pixels_per_group) {
    for (int lane = 0; lane < pixels_per_group; ++lane) {
      const std::int64_t pixel = std::min(first + lane, pixels - 1);
      load(raw, pixel, planes.depth_m[pixel], lane, group);
    }
    fit_single(curve_, group, fits);
    for (int lane = 0; lane < pixels_per_group && first + lane < pixels; ++lane) {
      const std::int64_t pixel = first + lane;
      const bool has_depth = std::isfinite(planes.depth_m[pixel]);
      const auto at = static_cast<std::size_t>(pixel);
      if (planes.returns)
        planes.returns[at] = has_depth ? ReturnStatus::single : ReturnStatus::none;
      for (float* plane : {planes.delay_m, planes.ratio})
        if (plane) plane[at] = std::numeric_limits<float>::quiet_NaN();
      if (!has_depth || is_single(fits.chi2[lane])) continue;
      queue.pixel[static_cast<std::size_t>(queue.count)] = pixel;
      queue.depth_m[static_cast<std::size_t>(queue.count)] = planes.depth_m[pixel];
      if (++queue.count == pixels_per_group) search(queue, raw, parts, planes);
    }
  }
  if (queue.count > 0) search(queue, raw, parts, planes);
}

void MultipathEngine::search(Queue& queue, const RawBlock& raw, const RangePart* parts,
                             const DecodedView& decoded) const {
  PixelGroup group;
  PairFits fits;
  for (int lane = 0; lane < pixels_per_group; ++lane) {
    const auto i = static_cast<std::size_t>(std::min(lane, queue.count - 1));
    load(raw, queue.pixel[i], queue.depth_m[i], lane, group);
    load_part(parts ? parts[queue.pixel[i]] : RangePart(), lane, group);
  }
  fit_pair(curve_, delays_, group, fits);
  for (int lane = 0; lane < queue.count; ++lane)
    store(queue.pixel[static_cast<std::size_t>(lane)], group, fits, lane, decoded);
  queue.count = 0;
}

double MultipathEngine::ambient_e_per_s(const PixelGroup& group, const PairFits& fits,
                                        int lane) const {
  const double per_row = 1.0 / curve_.points_per_row;
  const double row = fits.position[lane] * per_row;
  double later_row = row + fits.delay[lane] * per_row;
  if (later_row >= table().samples()) later_row -= table().samples();
  const RowMajorMatrix& later = kind_ == MultipathKind::tail ? gated_tail_ : gated_;
  double along = 0.0, own = 0.0;
  for (int k = 0; k < table().measurements(); ++k) {
    const double left = group.electrons[k][lane] -
                        fits.signal_e_per_s[lane] * on_chord(gated_, row, k) -
                        fits.second_e_per_s[lane] * on_chord(later, later_row, k);
    along += left * ambient_[k] / group.variance_e2[k][lane];
    own += ambient_[k] * ambient_[k] / group.variance_e2[k][lane];
  }
  return own > 0.0 ? along / own : std::numeric_limits<double>::quiet_NaN();
}

/// Stores light, confidence and residual of two returns, and replaces the status inconsistent if
/// they explain the pixel.
void MultipathEngine::replace_light(const PixelGroup& group, const PairFits& fits, int lane,
                                    std::size_t at, const DecodedView& decoded) const {
  const double chi2 = fits.chi2[lane];
  const double lead = std::max(fits.second_best_chi2[lane] - fits.chi2[lane], 0.0f);
  const auto confidence = static_cast<float>(probability_of(0.5 * lead));
  PixelDecoding pixel{.confidence = confidence};
  pixel.estimate.signal_e_per_s = fits.signal_e_per_s[lane];
  pixel.estimate.ambient_e_per_s = ambient_e_per_s(group, fits, lane);
  if (freedom_ > 0) pixel.residual.per_freedom = chi2 / freedom_;
  store_light(pixel, true, at, decoded);
  if (!decoded.status || decoded.status[at] != PixelStatus::inconsistent) return;
  if (chi2 > consistent_chi2_) return;
  decoded.status[at] = confidence < options_.status_thresholds.min_confidence
                           ? PixelStatus::ambiguous
                           : PixelStatus::ok;
}

void MultipathEngine::store(std::int64_t pixel, const PixelGroup& group, const PairFits& fits,
                            int lane, const DecodedView& decoded) const {
  const auto at = static_cast<std::size_t>(pixel);
  const double point_m = table().range_m / curve_.points;
  const float drop = fits.single_chi2[lane] - fits.chi2[lane];
  const bool are_two =
      drop > static_cast<float>(options_.threshold) && is_within(group, fits.position[lane], lane);
  const bool is_explained =
      is_single(fits.single_chi2[lane]) || fits.single_chi2[lane] <= unexplained_chi2_;
  if (decoded.returns && !are_two && !is_explained) decoded.returns[at] = ReturnStatus::unresolved;
  if (!are_two && !posterior_) return;

  double position = fits.position[lane], deviation = fits.deviation[lane];
  if (posterior_) {
    const DepthPosterior posterior =
        posterior_->around(curve_, group, lane, are_two ? position : group.guess[lane]);
    position = posterior.median, deviation = posterior.deviation;
  }
  if (decoded.bin)
    decoded.bin[at] =
        nearest_bin(table().in_bins(position / curve_.points_per_row), table().bin_count());
  const auto depth_m = static_cast<float>(position * point_m);
  decoded.depth_m[at] = depth_m < static_cast<float>(table().range_m) ? depth_m : 0.0f;
  if (decoded.deviation_m) decoded.deviation_m[at] = static_cast<float>(deviation * point_m);
  if (!are_two) return;
  if (decoded.returns) decoded.returns[at] = ReturnStatus::two;
  replace_light(group, fits, lane, at, decoded);
  if (decoded.ratio) decoded.ratio[at] = fits.second_e_per_s[lane] / fits.signal_e_per_s[lane];
  if (decoded.delay_m)
    decoded.delay_m[at] = static_cast<float>(
        kind_ == MultipathKind::tail ? options_.tail_m : fits.delay[lane] * point_m);
}

namespace {

/// Harmonics with more than 1 % of the largest amplitude.
int harmonics_of(const AmbientProjection& projection) {
  const PeriodicTransform transform(static_cast<int>(projection.curve.rows()));
  Eigen::VectorXd power = Eigen::VectorXd::Zero(transform.coefficients());
  Eigen::VectorXcd spectrum(transform.coefficients());
  for (Eigen::Index i = 0; i < projection.curve.cols(); ++i) {
    transform.forward(projection.curve.col(i), spectrum);
    power += spectrum.cwiseAbs2();
  }
  const Eigen::VectorXd harmonics = power.tail(power.size() - 1);
  return static_cast<int>((harmonics.array() > 1e-4 * harmonics.maxCoeff()).count());
}

}  // namespace

std::optional<BrokenRule> missing_support(const AmbientProjection& projection,
                                          MultipathKind later) {
  const bool sees_ambient = !projection.ambient.isZero(0.0);
  const int means = independent_directions(projection) + (sees_ambient ? 1 : 0);
  const int needed = (later == MultipathKind::tail ? 5 : 6) - (sees_ambient ? 0 : 1);
  if (means >= needed) return std::nullopt;
  const int harmonics = harmonics_of(projection);
  std::string rule = "must be >= " + std::to_string(needed) + " to distinguish ";
  rule += later == MultipathKind::tail ? "a tail" : "two returns";
  rule += " from one";
  if (harmonics <= 2)
    rule +=
        harmonics == 1
            ? "; the code has only one frequency, at which several returns are equivalent to one"
            : "; the code has only two frequencies, at which pairs of returns are ambiguous";
  rule += "; decode it with zncc or ml, or ";
  const Eigen::Index measurements = projection.gated.cols();
  if (measurements >= needed)  // too few independent means
    rule += "increase the number of harmonics: its " + std::to_string(measurements) +
            " measurements suffice, but contain too few harmonics; use a higher bandwidth of light "
            "and sensor (light.impulse_response, sensor.impulse_response) or a code with more "
            "harmonics";
  else
    rule +=
        "use a code with more means, such as hamiltonian-k5 on a sensor with two taps (--set "
        "sensor.taps=2), which has 10 measurements in 5 exposures";
  return broken("independent means", means, rule);
}

}  // namespace tofsmith

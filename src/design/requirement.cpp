// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "design/baselines.hpp"
#include "design/judge.hpp"
#include "design/optimize/design_problem.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {
namespace {

void scale_bandwidth(ImpulseResponse& response, double factor) {
  response.f_max_hz *= factor;
  response.cutoff_hz *= factor;
  response.time_step_s /= factor;
}

struct BestCode {
  double error_m = infinity;
  const CodeSet* code = nullptr;
};

using Codes = std::vector<const CodeSet*>;

CodeSet at_best_origin(const CodeSet& code, const Camera& camera, const DesignOptions& options) {
  if (!rotates(camera, options)) return code;
  const std::optional<CodeOnCamera> on = if_it_has_depth(code, camera);
  if (!on) return code;
  const EvaluateOptions search{.trials = options.trials, .seed = search_seed(options)};
  return code.rotated(best_rotation(*on, search).rotation_bin);
}

/// All codes found; each is evaluated on every modified camera.
class CodePool {
 public:
  CodePool(const Camera& camera, const RequirementOptions& options)
      : options_(options), design_(with_effort({}, options.effort)) {
    design_.seed = options.seed;
    design_.trials = std::clamp(options.trials / 10, 1000, 5000);
    DesignResult standard;
    add_baselines(camera, design_, {}, standard);
    for (const Candidate& candidate : standard.candidates) add(candidate.code, camera);
    design_.baselines = suggested_baselines(camera, design_);  // only these, for speed
  }

  /// Adds atlas codes or, for an exact answer, the winner of a design.
  /// @param exposures  of designs; empty: as design() selects them
  /// @param again  number of earlier designs for a similar camera; selects the seed
  void add_codes_for(const Camera& camera, const std::vector<int>& exposures,
                     const Progress& progress, int again = 0) {
    design_.exposures = exposures;
    if (!options_.exact) return add_atlas_codes_for(camera, progress);
    design_.seed = options_.seed + static_cast<std::uint64_t>(again);
    codes_.push_back(design(camera, design_, progress).winner().code);
  }

  /// Returns numbers of exposures within `difference` of the best code's number. Empty for lookups
  /// in the atlas.
  std::vector<int> exposures_near(const Camera& camera, int difference) const {
    if (!options_.exact) return {};
    const int best = best_on(camera, all()).code->exposures();
    std::vector<int> near;
    for (int exposures = best - difference; exposures <= best + difference; ++exposures)
      if (!why_not_optimizable(camera, exposures)) near.push_back(exposures);
    return near;
  }

  Codes all() const {
    Codes codes;
    for (const CodeSet& code : codes_) codes.push_back(&code);
    return codes;
  }

  Codes contenders(const Camera& a, const Camera& b) const {
    const std::vector<double> on_a = first_errors(a, all()), on_b = first_errors(b, all());
    const double least_a = *std::min_element(on_a.begin(), on_a.end());
    const double least_b = *std::min_element(on_b.begin(), on_b.end());
    Codes codes;
    for (std::size_t i = 0; i < codes_.size(); ++i)
      if (on_a[i] < 1.3 * least_a || on_b[i] < 1.3 * least_b) codes.push_back(&codes_[i]);
    return codes;
  }

  BestCode best_on(const Camera& camera, const Codes& codes) const {
    const std::vector<double> first = first_errors(camera, codes);
    const double least_m = *std::min_element(first.begin(), first.end());
    BestCode best;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (!(first[i] <= 1.1 * least_m)) continue;
      const double error_m = error_of({*codes[i], camera}, camera, options_.trials);
      if (error_m < best.error_m) best = {error_m, codes[i]};
    }
    return best;
  }

  /// Few trials decide clear cases.
  bool suffice_on(const Camera& camera, const Codes& codes) const {
    constexpr double far = 1.25;
    const double least_m = least_first_error_m(camera, codes);
    if (least_m > far * options_.error_m) return false;
    if (far * least_m < options_.error_m) return true;
    return best_on(camera, codes).error_m <= options_.error_m;
  }

  double least_first_error_m(const Camera& camera, const Codes& codes) const {
    const std::vector<double> first_m = first_errors(camera, codes);
    return *std::min_element(first_m.begin(), first_m.end());
  }

 private:
  void add_atlas_codes_for(const Camera& camera, const Progress& progress) {
    constexpr std::size_t most = 4;
    const std::vector<CodeSet> codes =
        contending_atlas_codes(camera, design_, first_trials()).codes;
    for (std::size_t i = 0; i < std::min(most, codes.size()); ++i) add(codes[i], camera);
    report(progress, 1.0, "atlas");
  }

  void add(const CodeSet& code, const Camera& camera) {
    CodeSet placed = at_best_origin(code, camera, design_);
    const auto is_placed = [&](const CodeSet& its) { return has_same_waveforms(its, placed); };
    if (std::none_of(codes_.begin(), codes_.end(), is_placed)) codes_.push_back(std::move(placed));
  }

  int first_trials() const { return std::max(1000, options_.trials / (options_.exact ? 10 : 25)); }

  /// Evaluates codes in parallel, because few trials use only one thread.
  std::vector<double> first_errors(const Camera& camera, const Codes& codes) const {
    std::vector<double> errors_m(codes.size(), infinity);
    parallel_for_indices(codes.size(), [&](std::size_t at) {
      if (const std::optional<CodeOnCamera> on = if_it_has_depth(*codes[at], camera))
        errors_m[at] = error_of(*on, camera, first_trials());
    });
    return errors_m;
  }

  double error_of(const CodeOnCamera& on, const Camera& camera, int trials) const {
    const EvaluateOptions judging{.trials = trials, .seed = options_.seed + 2, .bounds = false};
    return geometric_mean_error_m(evaluate(on, judging), camera.operating.measure());
  }

  RequirementOptions options_;
  DesignOptions design_;
  std::deque<CodeSet> codes_;  // keeps pointers valid
};

/// Geometric mean over the operating points [m]; infinity if no number of exposures is possible.
double bound_m(const Camera& given) {
  const Camera camera = judged_camera(given);
  const std::vector<OperatingPoint> points = camera.operating.points();
  double least_m = infinity;
  for (int exposures = 1; exposures <= 8; ++exposures) {
    const std::size_t listed = camera.exposure_s.each_s.size();
    if (listed != 0 && listed != static_cast<std::size_t>(exposures)) continue;
    const ReceiverBound bound(camera, exposures);
    double log_sum = 0.0;
    for (OperatingPoint point : points) {
      point.signal_e_per_s *= camera.operating.albedo;
      log_sum += std::log(camera.operating.uniform_albedo ? bound.mae_uniform_albedo_m(point)
                                                          : bound.mae_m(point));
    }
    least_m = std::min(least_m, std::exp(log_sum / static_cast<double>(points.size())));
  }
  return least_m;
}

constexpr double relative_step = 0.005;

/// `suffices` must hold at high and not at low.
template <typename Suffices>
double least_between(double low, double high, Suffices&& suffices) {
  while (high / low > 1.0 + relative_step) {
    const double middle = std::sqrt(low * high);
    (suffices(middle) ? high : low) = middle;
  }
  return high;
}

double excluded_below(const Camera& camera, CameraQuantity quantity,
                      const RequirementOptions& options) {
  const auto may_suffice = [&](double factor) {
    return bound_m(with_scaled(camera, quantity, factor)) <= options.error_m;
  };
  const double least = 1.0 / options.max_factor;
  if (may_suffice(least)) return 0.0;
  if (!may_suffice(options.max_factor)) return options.max_factor;
  return least_between(least, options.max_factor, may_suffice);
}

constexpr double stride = 4.0;  ///< factor between designs
/// The error of each design varies by a few percent.
constexpr int end_designs = 3;
/// Repeated lookups in the atlas find the same codes.
int designs_at_end(const RequirementOptions& options) { return options.exact ? end_designs : 1; }

/// Scales the quantity by strides, with a design at each, then bisects.
Sufficiency sufficiency_of(CameraQuantity quantity, const Camera& camera,
                           const RequirementOptions& options, CodePool& pool,
                           const Progress& progress) {
  std::optional<double> least;
  const int most_steps =
      static_cast<int>(std::ceil(std::log(options.max_factor) / std::log(stride)));
  const ProgressParts parts(progress,
                            static_cast<std::size_t>(most_steps + designs_at_end(options)));
  const auto on = [&](double factor) { return with_scaled(camera, quantity, factor); };
  const auto suffices = [&](double factor) { return pool.suffice_on(on(factor), pool.all()); };
  const auto design_at = [&](double factor, int difference, std::size_t part, int again = 0) {
    const Camera there = on(factor);
    pool.add_codes_for(there, pool.exposures_near(there, difference), parts[part], again);
  };
  const auto least_within = [&](double low, double high) {
    const Codes codes = pool.contenders(on(low), on(high));
    return least_between(low, high,
                         [&](double factor) { return pool.suffice_on(on(factor), codes); });
  };

  const bool upwards = !suffices(1.0);
  double low = 1.0, high = 1.0;
  bool bracketed = false;
  std::size_t part = 0;
  for (int step = 1; step <= most_steps && !bracketed; ++step) {
    const double factor = std::clamp(upwards ? high * stride : low / stride,
                                     1.0 / options.max_factor, options.max_factor);
    // Bandwidth changes the best number of exposures and the similar cameras of the atlas.
    if (options.exact || quantity == CameraQuantity::bandwidth)
      design_at(factor, quantity == CameraQuantity::bandwidth ? 1 : 0, part++);
    const bool met = suffices(factor);
    if (upwards) {
      if (!met) low = factor;
      high = factor;
      bracketed = met;
    } else {
      if (met) high = factor;
      low = factor;
      bracketed = !met;
    }
  }
  const auto finish = [&](double factor) {
    const BestCode best = pool.best_on(on(factor), pool.all());
    report(progress, 1.0, std::string(name_of(quantity)));
    return Sufficiency{.quantity = quantity,
                       .factor = least,
                       .error_m = best.error_m,
                       .code = *best.code,
                       .excluded_below = excluded_below(camera, quantity, options)};
  };
  if (!bracketed && upwards) return finish(options.max_factor);
  if (!bracketed) {
    least = 1.0 / options.max_factor;
    return finish(*least);
  }

  // New designs at the result while they lower it.
  least = least_within(low, high);
  for (int round = 0; round < designs_at_end(options); ++round) {
    design_at(*least, 1, part++, round);
    const double before = *least;
    if (suffices(before / stride)) break;
    least = least_within(before / stride, before);
    if (round > 0 && before / *least < 1.0 + 2.0 * relative_step) break;
  }
  return finish(*least);
}

std::vector<double> map_factors(double least, double most) {
  std::vector<double> factors;
  for (double factor = least; factor <= most * 1.01; factor *= std::sqrt(2.0))
    factors.push_back(factor);
  return factors;
}

RequirementMap map_of(const Camera& camera, CodePool& pool, const Progress& progress) {
  RequirementMap map{map_factors(0.25, 4.0), map_factors(1.0 / 16.0, 16.0), {}};
  map.error_m.resize(std::ssize(map.bandwidth), std::ssize(map.power));
  const ProgressParts parts(progress, map.bandwidth.size());
  for (std::size_t b = 0; b < map.bandwidth.size(); ++b) {
    const Camera of_band = with_scaled(camera, CameraQuantity::bandwidth, map.bandwidth[b]);
    if (b % 2 == 0) pool.add_codes_for(of_band, pool.exposures_near(of_band, 1), parts[b]);
    const Codes codes = pool.contenders(of_band, of_band);
    for (std::size_t p = 0; p < map.power.size(); ++p)
      map.error_m(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(p)) =
          pool.least_first_error_m(with_scaled(of_band, CameraQuantity::power, map.power[p]),
                                   codes);
  }
  return map;
}

}  // namespace

Camera with_scaled(Camera camera, CameraQuantity quantity, double factor) {
  require(std::isfinite(factor) && factor > 0.0, "factor", factor, "must be finite and > 0");
  switch (quantity) {
    case CameraQuantity::bandwidth: {
      ImpulseResponse &light = camera.light.impulse_response,
                      &sensor = camera.sensor.impulse_response;
      require(
          light.kind != ImpulseResponse::Kind::none || sensor.kind != ImpulseResponse::Kind::none,
          "impulse_response", "none",
          "must be set for at least one arm to vary the bandwidth, such as "
          "light.impulse_response = { kind = \"lowpass\", cutoff_hz = 100e6 }");
      scale_bandwidth(light, factor);
      scale_bandwidth(sensor, factor);
      if (camera.sensor.shortest_pulse_s) *camera.sensor.shortest_pulse_s /= factor;
      break;
    }
    case CameraQuantity::power:
      for (double& signal_e_per_s : camera.operating.signal_e_per_s) signal_e_per_s *= factor;
      if (camera.optics) camera.optics->source_power_w *= factor;
      break;
    case CameraQuantity::exposure:
      camera.exposure_s.total_s *= factor;
      for (double& exposure_s : camera.exposure_s.each_s) exposure_s *= factor;
      camera.sensor.frame_period_s.reset();
      break;
  }
  return camera;
}

std::vector<CameraQuantity> RequirementOptions::varied() const {
  std::vector<CameraQuantity> quantities;
  if (vary_bandwidth) quantities.push_back(CameraQuantity::bandwidth);
  if (vary_power) quantities.push_back(CameraQuantity::power);
  if (vary_exposure) quantities.push_back(CameraQuantity::exposure);
  return quantities;
}

void RequirementOptions::validate() const {
  check_fields(*this, "RequirementOptions::");
  require(!varied().empty(), "RequirementOptions::vary", "nothing",
          "must be at least one of bandwidth, power, exposure");
}

Requirements find_requirements(const Camera& asked, const RequirementOptions& options,
                               const Progress& progress) {
  options.validate();
  asked.validate();
  Camera camera = asked;
  camera.operating.error = DepthErrorKind::circular;
  const std::vector<CameraQuantity> quantities = options.varied();
  for (const CameraQuantity quantity : quantities)
    static_cast<void>(with_scaled(camera, quantity, 1.0));  // throws before long work
  const bool has_map = options.map && options.vary_bandwidth && options.vary_power;
  std::vector<double> weights{1.0};
  weights.insert(weights.end(), quantities.size(), 8.0);
  weights.push_back(has_map ? 10.0 : 0.0);
  const ProgressParts parts(progress, weights);

  CodePool pool(camera, options);
  pool.add_codes_for(camera, {}, parts[0]);
  const BestCode now = pool.best_on(camera, pool.all());
  Requirements found{.error_m = now.error_m,
                     .code = *now.code,
                     .bound_m = bound_m(camera),
                     .varied = {},
                     .map = {}};
  for (std::size_t i = 0; i < quantities.size(); ++i)
    found.varied.push_back(sufficiency_of(quantities[i], camera, options, pool, parts[i + 1]));
  if (has_map) found.map = map_of(camera, pool, parts[quantities.size() + 1]);
  report(progress, 1.0, "done");
  return found;
}

}  // namespace tofsmith

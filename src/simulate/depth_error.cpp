// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "camera/shared/actual_code.hpp"
#include "simulate/depth_trials.hpp"
#include "simulate/pixel_trials.hpp"
#include "simulate/shared/camera_bounds.hpp"
#include "simulate/shared/code_on_camera.hpp"
#include "simulate/shared/error_by_rotation.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {

namespace {

template <typename Bound>
double bound_mae_m(const Bound& bound, const Camera& camera, const OperatingPoint& point) {
  if (camera.operating.uniform_albedo) return bound.mae_uniform_albedo_m(point);
  return bound.mae_m({camera.operating.albedo * point.signal_e_per_s, point.ambient_e_per_s});
}

/// Replaces 0, which means no bound, by NaN.
double bound_or_nan(double bound_m) {
  return bound_m == 0.0 ? std::numeric_limits<double>::quiet_NaN() : bound_m;
}

}  // namespace

Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials, std::uint64_t seed) {
  const EvaluateOptions options{.trials = trials, .seed = seed};
  const DepthTrials of_table(table, light, options);
  return sum_errors(of_table, of_table.first_rounds(), 0.0, {}).front().circular(table.bin_m());
}

void EvaluateOptions::validate() const { check_fields(*this); }

CodeOnCamera::CodeOnCamera(const CodeSet& fitting, const Camera& given)
    : code(fitting),
      camera(judged_camera(given)),
      model(code, camera),
      table(make_decoding_table(model, camera)) {}

namespace {

DepthErrorReport errors_without_bounds(const CodeOnCamera& on, const EvaluateOptions& options,
                                       const Progress& progress) {
  const DepthTrials trials(on.model, on.camera, options, on.table);
  return trial_errors(trials, on.code, on.camera, options, progress);
}

}  // namespace

DepthErrorReport evaluate(const CodeOnCamera& on, const EvaluateOptions& options,
                          const Progress& progress) {
  DepthErrorReport result = errors_without_bounds(on, options, progress);
  report(progress, 1.0, "depth error");
  return result;
}

std::vector<PointColumn> point_columns(const PointDepthError& point) {
  std::vector<PointColumn> columns;
  for_each_field(point, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if constexpr (std::is_same_v<Value, OperatingPoint>) {
      for_each_field(field.value, [&](const auto& light) {
        columns.push_back({light.name, light.value});
      });
    } else if constexpr (std::is_same_v<Value, Estimate>) {
      columns.push_back({field.name, field.value.value});
      if (!field.is(FieldMark::without_error))
        columns.push_back({error_name(field.name), field.value.standard_error});
    } else if constexpr (std::is_same_v<Value, double>) {
      const bool may_be_null = field.is(FieldMark::may_be_null);
      columns.push_back({field.name, may_be_null ? bound_or_nan(field.value) : field.value});
    }
  });
  return columns;
}

const std::vector<CameraBounds::Level>& CameraBounds::of(const CodeSet& code) {
  const std::pair key(code.exposures(), code.exposure_shares());
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = levels_.find(key); found != levels_.end()) return found->second;
  }
  std::vector<Level> levels;
  const Camera camera = judged_camera(camera_);
  const ReceiverBound receiver(timed_by(code, camera), code.exposures());
  const DirectTofBound direct_tof(camera);
  const bool has_rows = camera.sensor.readout == Readout::rows;  // HistogramBound applies instead
  for (const OperatingPoint& point : camera.operating.points())
    levels.push_back({has_rows ? 0.0 : bound_mae_m(receiver, camera, point),
                      bound_mae_m(direct_tof, camera, point)});
  const std::lock_guard lock(mutex_);
  return levels_.try_emplace(key, std::move(levels)).first->second;
}

DepthErrorReport evaluate(const CodeSet& code, const Camera& given, const EvaluateOptions& options,
                          CameraBounds& bounds, const Progress& progress) {
  const CodeOnCamera on(code, given);
  if (!options.bounds) return evaluate(on, options, progress);
  DepthErrorReport result = errors_without_bounds(on, options, progress);
  const Camera& camera = on.camera;
  const CramerRaoBound cramer_rao(on.model, camera);
  std::optional<HistogramBound> histogram;
  if (on.model.has_rows()) histogram.emplace(on.model, camera);
  const std::vector<CameraBounds::Level>& levels = bounds.of(code);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    PointDepthError& error = result.points[i];
    error.cramer_rao_mae_m = bound_mae_m(cramer_rao, camera, error.point);
    error.receiver_bound_mae_m =
        histogram ? bound_mae_m(*histogram, camera, error.point) : levels[i].receiver_mae_m;
    error.direct_tof_bound_mae_m = levels[i].direct_tof_mae_m;
  }
  report(progress, 1.0, "depth error");
  return result;
}

DepthErrorReport evaluate(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                          const Progress& progress) {
  CameraBounds bounds(camera);
  return evaluate(code, camera, options, bounds, progress);
}

std::string exposures_by_taps(const DepthErrorReport& error) {
  const int per_exposure = error.measurements / std::max(1, error.exposures);
  return fmt::format("{} x {}", error.exposures, per_exposure);
}

namespace {

/// Sums of errors at every rotation, and their averages over origins within half a bin.
struct SumsByRotation {
  std::vector<double> at_origin, over_origins;
};

template <typename Errors>
std::vector<SumsByRotation> sums_by_rotation(const DepthTrials& trials,
                                             std::span<const TrialRound> rounds, const Errors& none,
                                             const Progress& progress) {
  constexpr std::int64_t runs_at_once = 64;
  const std::vector<Errors> of_round = trials.sum(
      rounds, none,
      [](Errors& errors, const TrialBlock& block) {
        for (std::size_t t = 0; t < block.true_bin.size(); ++t)
          errors.add(block.true_bin[t], block.decoded_bin[t]);
      },
      progress, runs_at_once);
  std::vector<SumsByRotation> sums;
  for (const Errors& errors : of_round)
    sums.push_back({errors.sums(), errors.means_over_origins()});
  return sums;
}

}  // namespace

BestRotation best_rotation(const CodeSet& code, const Camera& camera,
                           const EvaluateOptions& options, const Progress& progress) {
  return best_rotation(CodeOnCamera(code, camera), options, progress);
}

BestRotation best_rotation(const CodeOnCamera& on, const EvaluateOptions& options,
                           const Progress& progress) {
  const DepthPrior prior(on.camera);
  // Uniform depths serve all rotations.
  Camera camera = on.camera;
  DecodingTable table = on.table;
  camera.operating.depths.reset();
  camera.operating.working_distance_m.reset();
  table.working_distance_m.reset();
  const DepthTrials trials(on.model, camera, options, std::move(table));
  const std::vector<TrialRound> rounds = trials.first_rounds();
  const int samples = trials.samples();
  const std::vector<SumsByRotation> of_point =
      prior.is_uniform()
          ? sums_by_rotation(trials, rounds, ErrorByRotation(samples), progress)
          : sums_by_rotation(trials, rounds,
                             WeighedErrorByRotation(prior, camera.operating.error, samples),
                             progress);

  constexpr double tiny_m = 1e-12;  // avoids log(0), which smoothing would spread
  std::vector<double> log_sum(static_cast<std::size_t>(samples), 0.0), choice = log_sum;
  for (std::size_t p = 0; p < of_point.size(); ++p)
    for (std::size_t r = 0; r < log_sum.size(); ++r) {
      const double scale = camera.bin_m() / static_cast<double>(rounds[p].trials);
      log_sum[r] += std::log(of_point[p].at_origin[r] * scale);
      choice[r] += std::log(std::max(of_point[p].over_origins[r] * scale, tiny_m));
    }
  BestRotation best;
  for (const double sum : log_sum)
    best.linear_geometric_mean_m.push_back(std::exp(sum / static_cast<double>(of_point.size())));
  choice = smoothed_over_rotations(choice);
  for (int r = 0; r < std::ssize(choice); ++r)
    if (!plays_alike_rotated(camera, trials.samples(), r))
      choice[static_cast<std::size_t>(r)] = std::numeric_limits<double>::infinity();
  // After a rotation, rounding errors may remove a narrow pulse on the points of the generator.
  for (;;) {
    best.rotation_bin = best_of_rotations(choice);
    if (best.rotation_bin == 0 || !why_not_playable(on.code.rotated(best.rotation_bin), camera))
      return best;
    choice[static_cast<std::size_t>(best.rotation_bin)] = std::numeric_limits<double>::infinity();
  }
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <optional>

#include "simulate/shared/camera_bounds.hpp"
#include "simulate/trial_errors.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {
namespace {

template <typename Bound>
double bound_mae_m(const Bound& bound, const Camera& camera, const OperatingPoint& point) {
  if (camera.operating.uniform_albedo) return bound.mae_uniform_albedo_m(point);
  return bound.mae_m({camera.operating.albedo * point.signal_e_per_s, point.ambient_e_per_s});
}

}  // namespace

Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials, std::uint64_t seed) {
  const EvaluateOptions options{.trials = trials, .seed = seed};
  const DepthTrials of_table(table, light, options);
  return sum_errors(of_table, of_table.first_rounds(), 0.0, {}).front().circular(table.bin_m());
}

void EvaluateOptions::validate() const { check_fields(*this); }

const std::vector<CameraBounds::Level>& CameraBounds::of(const CodeSet& code) {
  const auto [found, is_new] =
      levels_.try_emplace(std::pair(code.exposures(), code.exposure_shares()));
  if (!is_new) return found->second;
  const Camera camera = judged_camera(camera_);
  const ReceiverBound receiver(timed_by(code, camera), code.exposures());
  const DirectTofBound direct_tof(camera);
  const bool has_rows = camera.sensor.readout == Readout::rows;  // HistogramBound applies instead
  for (const OperatingPoint& point : camera.operating.points())
    found->second.push_back({has_rows ? 0.0 : bound_mae_m(receiver, camera, point),
                             bound_mae_m(direct_tof, camera, point)});
  return found->second;
}

DepthErrorReport evaluate(const CodeSet& code, const Camera& on, const EvaluateOptions& options,
                          CameraBounds& bounds, const Progress& progress) {
  const Camera camera = judged_camera(on);
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera, options);
  DepthErrorReport result = trial_errors(trials, code, camera, options, progress);
  if (!options.bounds) {
    report(progress, 1.0, "depth error");
    return result;
  }
  const CramerRaoBound cramer_rao(model, camera);
  std::optional<HistogramBound> histogram;
  if (model.has_rows()) histogram.emplace(model, camera);
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

}  // namespace tofsmith

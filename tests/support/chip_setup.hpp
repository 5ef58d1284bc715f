// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "design/chips/chip_candidates.hpp"
#include "design/chips/chip_judge.hpp"
#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

inline Camera chip_camera(int chips, int taps, const OperatingPoint& point) {
  Camera camera = built_in_camera("exclusive-3tap-9chip");
  camera.operating.signal_e_per_s = {point.signal_e_per_s};
  camera.operating.ambient_e_per_s = {point.ambient_e_per_s};
  camera.sensor.taps = taps;
  camera.sensor.shortest_pulse_s = 1.0 / (camera.fundamental_frequency_hz * chips);
  return camera;
}

/// RMS over depth of the standard deviation of the best unbiased depth estimate [m], by ChipJudge.
inline double chip_metric_rms_m(const ChipCode& code, const Camera& camera,
                                const OperatingPoint& point,
                                ChipMetric metric = ChipMetric::unknown_light) {
  Camera at_point = camera;
  at_point.sensor.taps = code.taps;
  at_point.operating.signal_e_per_s = {point.signal_e_per_s};
  at_point.operating.ambient_e_per_s = {point.ambient_e_per_s};
  const ChipJudge judge(at_point, {.exposures = code.exposures(), .metric = metric});
  return judge.rms_m(judge.score(code));
}

/// Smallest noise-normalized distance between depths, by ChipMargin [standard deviations].
inline double ambiguity_margin_sigma(const ChipCode& code, const Camera& camera,
                                     const OperatingPoint& point,
                                     double separation_periods = 1.0 / 36.0) {
  const ChipLight light(camera, point, code.chips, code.exposures());
  return ChipMargin(code, light, separation_periods).proven_sigma();
}

struct ComparedCode {
  std::string name;
  double rms_m = 0.0;       ///< root mean square over depth of CramerRaoBound::sigma_m
  Estimate circular_mde_m;  ///< Monte Carlo, maximum likelihood
};

/// Evaluates each code with maximum likelihood at the camera's only operating point; taps and
/// samples of the camera are set to the code's.
inline std::vector<ComparedCode> compare_chip_codes(const std::vector<StandardCode>& codes,
                                                    const Camera& camera, EvaluateOptions options) {
  options.method = DecodeMethod::ml;
  options.bounds = false;
  std::vector<ComparedCode> table;
  for (const StandardCode& standard : codes) {
    const CodeSet& code = standard.code;
    Camera fitted = camera;
    fitted.sensor.taps = code.taps();
    fitted.samples = code.samples();
    const DepthErrorReport report = evaluate(code, fitted, options);
    const Eigen::VectorXd sigma_m = CramerRaoBound(ForwardModel(code, fitted), fitted)
                                        .sigma_m(camera.operating.points().front());
    table.push_back({standard.name, std::sqrt(sigma_m.squaredNorm() / double(sigma_m.size())),
                     report.points.front().circular_mde_m});
  }
  return table;
}

}  // namespace tofsmith

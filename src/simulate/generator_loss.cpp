// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <cmath>

#include "simulate/trial_errors.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

std::vector<double> correlation_changes(const ForwardModel& told, const ForwardModel& played,
                                        int points) {
  const Eigen::MatrixXd a = told.correlation_table(points), b = played.correlation_table(points);
  std::vector<double> changes;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double variation = (a.col(k).array() - a.col(k).mean()).matrix().norm();
    const double change = (b.col(k) - a.col(k)).norm();
    changes.push_back(variation > 0.0 ? change / variation : change);
  }
  return changes;
}

}  // namespace

double GeneratorLoss::ratio(DepthErrorKind kind) const {
  return played.of(kind).geometric_mean_m.value / told_m(kind).value;
}

double GeneratorLoss::uncalibrated_ratio(DepthErrorKind kind) const {
  return uncalibrated.of(kind).geometric_mean_m.value / told_m(kind).value;
}

GeneratorLoss generator_loss(const CodeSet& code, const Camera& camera,
                             const EvaluateOptions& options, const Progress& progress) {
  options.validate();
  Camera ideal = camera;
  ideal.light.generator.reset();
  ideal.sensor.generator.reset();
  const ForwardModel told(code, ideal), played(code, camera);
  const DecodingTable told_table = make_decoding_table(told, ideal),
                      played_table = make_decoding_table(played, camera);
  const ProgressParts parts(progress, 3);
  const auto error = [&](const ForwardModel& model, const DecodingTable& believed,
                         std::size_t part) {
    const DepthTrials trials(model, camera, options, believed);
    return trial_errors(trials, code, camera, options, parts[part]);
  };
  return {.told = error(told, told_table, 0),
          .played = error(played, played_table, 1),
          .uncalibrated = error(played, told_table, 2),
          .correlation_change = correlation_changes(told, played, 8 * camera.samples)};
}

}  // namespace tofsmith

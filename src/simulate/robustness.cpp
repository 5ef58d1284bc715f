// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/trial_errors.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {
namespace {

std::vector<double> correlation_changes(const ForwardModel& nominal, const ForwardModel& actual,
                                        int points) {
  const Eigen::MatrixXd a = nominal.correlation_table(points), b = actual.correlation_table(points);
  std::vector<double> changes;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double variation = (a.col(k).array() - a.col(k).mean()).matrix().norm();
    const double change = (b.col(k) - a.col(k)).norm();
    changes.push_back(variation > 0.0 ? change / variation : change);
  }
  return changes;
}

const Estimate& larger(const Estimate& a, const Estimate& b) { return b.value > a.value ? b : a; }

class Judge {
 public:
  Judge(DepthErrorKind kind, const RobustnessOptions& options)
      : kind_(kind),
        options_{.trials = options.trials,
                 .seed = options.seed,
                 .method = options.method,
                 .unwrap_weights = options.unwrap_weights} {}

  Estimate error_m(const CodeSet& code, const Camera& camera, const ForwardModel& model,
                   const DecodingTable& believed, const Progress& progress) const {
    const DepthTrials trials(model, camera, options_, believed);
    return trial_errors(trials, code, camera, options_, progress).of(kind_).geometric_mean_m;
  }

 private:
  DepthErrorKind kind_;
  EvaluateOptions options_;
};

}  // namespace

double GeneratorLoss::ratio(DepthErrorKind kind) const {
  return actual.of(kind).geometric_mean_m.value / nominal_m(kind).value;
}

double GeneratorLoss::uncalibrated_ratio(DepthErrorKind kind) const {
  return uncalibrated.of(kind).geometric_mean_m.value / nominal_m(kind).value;
}

GeneratorLoss generator_loss(const CodeSet& code, const Camera& on, const EvaluateOptions& options,
                             const Progress& progress) {
  const Camera camera = judged_camera(on);
  options.validate();
  Camera ideal = camera;
  ideal.light.generator.reset();
  ideal.sensor.generator.reset();
  const ForwardModel nominal(code, ideal), actual(code, camera);
  const DecodingTable nominal_table = make_decoding_table(nominal, ideal),
                      actual_table = make_decoding_table(actual, camera);
  const ProgressParts parts(progress, 3);
  const auto error = [&](const ForwardModel& model, const DecodingTable& believed,
                         std::size_t part) {
    const DepthTrials trials(model, camera, options, believed);
    return trial_errors(trials, code, camera, options, parts[part]);
  };
  return {.nominal = error(nominal, nominal_table, 0),
          .actual = error(actual, actual_table, 1),
          .uncalibrated = error(actual, nominal_table, 2),
          .correlation_change = correlation_changes(nominal, actual, 8 * camera.samples)};
}

void RobustnessOptions::validate() const { check_fields(*this); }

Estimate RobustnessReport::worst_calibrated_m() const {
  Estimate worst = nominal_m;
  for (const PerturbedError& p : perturbed) worst = larger(worst, p.calibrated_m);
  return worst;
}

Estimate RobustnessReport::worst_uncalibrated_m() const {
  Estimate worst = nominal_m;
  for (const PerturbedError& p : perturbed) worst = larger(worst, p.uncalibrated_m);
  return worst;
}

RobustnessReport robustness(const CodeSet& code, const Camera& on, const RobustnessOptions& options,
                            const Progress& progress) {
  const Camera camera = judged_camera(on);
  const std::vector<PerturbedCamera> cameras = perturbations(camera, options);
  const DepthErrorKind kind = camera.operating.error;
  const Judge judge(kind, options);
  const ProgressParts parts(progress, 2 * cameras.size() + 1);

  const ForwardModel said(code, camera);
  const DecodingTable said_table = make_decoding_table(said, camera);
  RobustnessReport report{.kind = kind,
                          .trials = options.trials + options.trials % 2,
                          .seed = options.seed,
                          .nominal_m = judge.error_m(code, camera, said, said_table, parts[0]),
                          .perturbed = {}};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& actual = cameras[i].camera;
    const CodeSet actual_code = perturbed_code(code, cameras[i]);
    if (why_not_playable(actual_code, actual)) continue;
    const ForwardModel model(actual_code, actual);
    const DecodingTable table = make_decoding_table(model, actual);
    const DecodingTable& calibrated = why_not_decodable(table) ? said_table : table;
    report.perturbed.push_back(
        {.name = cameras[i].name,
         .calibrated_m = judge.error_m(actual_code, actual, model, calibrated, parts[2 * i + 1]),
         .uncalibrated_m =
             judge.error_m(actual_code, actual, model, said_table, parts[2 * i + 2])});
  }
  return report;
}

}  // namespace tofsmith

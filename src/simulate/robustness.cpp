// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <algorithm>

#include "simulate/trial_errors.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

const Estimate& larger(const Estimate& a, const Estimate& b) { return b.value > a.value ? b : a; }

/// What is the same for every camera of a report.
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

void RobustnessOptions::validate() const {
  check_fields(*this);
}

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

RobustnessReport robustness(const CodeSet& code, const Camera& camera,
                            const RobustnessOptions& options, const Progress& progress) {
  const std::vector<PerturbedCamera> cameras = perturbations(camera, options);
  const DepthErrorKind kind = camera.operating.error;
  const Judge judge(kind, options);
  const auto runs = static_cast<double>(2 * cameras.size() + 1);
  const auto part = [&](std::size_t run) {
    return part_of(progress, static_cast<double>(run) / runs, static_cast<double>(run + 1) / runs);
  };

  const ForwardModel said(code, camera);
  const DecodingTable said_table = make_decoding_table(said, camera);
  RobustnessReport report{.kind = kind,
                          .trials = options.trials + options.trials % 2,
                          .seed = options.seed,
                          .nominal_m = judge.error_m(code, camera, said, said_table, part(0)),
                          .perturbed = {}};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& actual = cameras[i].camera;
    const CodeSet played = perturbed_code(code, cameras[i]);
    const ForwardModel model(played, actual);
    const DecodingTable table = make_decoding_table(model, actual);
    report.perturbed.push_back(
        {.name = cameras[i].name,
         .calibrated_m = judge.error_m(played, actual, model, table, part(2 * i + 1)),
         .uncalibrated_m = judge.error_m(played, actual, model, said_table, part(2 * i + 2))});
  }
  return report;
}

}  // namespace tofsmith

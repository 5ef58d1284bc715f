// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/rows/dim_light.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

Camera in_share_of_light(Camera camera, double share) {
  for (double& signal : camera.operating.signal_e_per_s) signal *= share;
  for (double& ambient : camera.operating.ambient_e_per_s) ambient *= share;
  return camera;
}

std::optional<std::string> dim_light_note(const Camera& camera, const DesignResult& result,
                                          const DesignOptions& options) {
  constexpr int max_trials = 4000;
  constexpr double standard_errors = 3.0;
  const DepthErrorMeasure measure = camera.operating.measure();
  std::vector<double> signal = camera.operating.signal_e_per_s,
                      ambient = camera.operating.ambient_e_per_s;
  std::sort(signal.begin(), signal.end());
  std::sort(ambient.begin(), ambient.end());
  Camera dim = camera;
  dim.operating.signal_e_per_s = {signal.front()};
  dim = in_share_of_light(dim, dim_share);
  const auto error_of = [&](const CodeSet& code) {
    const EvaluateOptions judging{
        .trials = std::min(options.trials, max_trials), .seed = options.seed, .bounds = false};
    return evaluate(code, dim, judging).of(measure).geometric_mean_m;
  };
  const Candidate& winner = result.winner();
  const Candidate* best = nullptr;
  Estimate least{infinity, 0.0};
  for (const Candidate& other : result.candidates) {
    if (&other == &winner || other.is_designed()) continue;
    if (const Estimate error = error_of(other.code); error.value < least.value)
      best = &other, least = error;
  }
  if (!best) return std::nullopt;
  const Estimate its = error_of(winner.code);
  if (its.value - least.value <=
      standard_errors * std::hypot(its.standard_error, least.standard_error))
    return std::nullopt;
  signal.insert(signal.begin(), dim_share * signal.front());
  if (ambient.front() > 0.0) ambient.insert(ambient.begin(), dim_share * ambient.front());
  return fmt::format(
      "At a tenth of the lowest signal (S = {:g} e/s, with a tenth of the ambient light), the "
      "error of the best code is {} mm and the error of {} is {} mm. If the light can be so dim, "
      "include these levels in the design: operating.signal_e_per_s = [{:g}] and "
      "operating.ambient_e_per_s = [{:g}].",
      signal.front(), plain_number(1e3 * its.value, 3), best->code.name(),
      plain_number(1e3 * least.value, 3), fmt::join(signal, ", "), fmt::join(ambient, ", "));
}

}  // namespace tofsmith

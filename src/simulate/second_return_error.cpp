// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/second_return_error.hpp"

#include <algorithm>

#include "simulate/trial_errors.hpp"

namespace tofsmith {

DepthErrorReport second_return_error(const CodeSet& code, const Camera& camera,
                                     const SecondReturns& later, const EvaluateOptions& options,
                                     const Progress& progress) {
  later.validate(camera.range_m());
  DepthTrials trials(ForwardModel(code, camera), camera, options);
  trials.add_second_returns(later);
  return trial_errors(trials, code, camera.bin_m(), options, progress);
}

Estimate two_return_error_m(const CodeSet& code, const Camera& camera, const SecondReturns& later,
                            const EvaluateOptions& options, const Progress& progress) {
  later.validate(camera.range_m());
  const ForwardModel model(code, camera);
  MultipathOptions decoding;
  decoding.shortest_delay_m = std::min(decoding.shortest_delay_m, later.shortest_delay_m);
  decoding.longest_delay_m = std::max(later.longest_delay_m, camera.range_m() / 3);
  DepthTrials trials(model, camera, options);
  trials.add_second_returns(later);
  trials.decode_as(TwoReturnDecoder(make_decoding_table(model, camera), decoding));
  return trial_errors(trials, code, camera.bin_m(), options, progress).circular.geometric_mean_m;
}

}  // namespace tofsmith

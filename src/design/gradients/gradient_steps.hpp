// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "design/gradients/between_bins.hpp"
#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/design/code_gradients.hpp"

namespace tofsmith {

/// What the steps of CodeGradients stand on.
struct CodeGradients::Steps {
  Steps(const Camera& its, int samples, int exposures);

  bool has_shot() const { return sampled.subtracts(); }
  /// Of all measurements and, where they are differences, of the light behind them: (K) or (2 K).
  BetweenBins::Functions functions_of(const MeasurementTable& table) const;
  void pull_back_functions(const BetweenBins::Functions& gradient,
                           MeasurementTable& by_table) const;

  Camera camera;
  SampledCamera sampled;
  BetweenBins between;
  int exposures;
};

/// Pixels whose gradients are summed together: whole blocks, in 64 groups at most, whatever the
/// number of threads.
std::int64_t pixels_in_a_group(std::int64_t pixels);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "design/gradients/between_bins.hpp"
#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/design/code_gradients.hpp"

namespace tofsmith {

/// Shared state of the steps of CodeGradients.
struct CodeGradients::Steps {
  Steps(const Camera& its, int samples, int exposures);

  bool has_shot() const { return sampled.subtracts(); }
  /// Returns the functions of all measurements (K), followed for differences by the total light of
  /// each (2 K).
  BetweenBins::Functions functions_of(const MeasurementTable& table) const;
  void pull_back_functions(const BetweenBins::Functions& gradient,
                           MeasurementTable& by_table) const;

  Camera camera;
  SampledCamera sampled;
  BetweenBins between;
  int exposures;
};

/// Returns the number of pixels whose gradients are summed together: whole blocks, at most 64
/// groups. Independent of the number of threads.
std::int64_t pixels_in_a_group(std::int64_t pixels);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "design/gradients/between_bins.hpp"
#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/design/code_gradients.hpp"

namespace tofsmith {

struct CodeGradients::Steps {
  Steps(const Camera& its, int samples, int exposures);

  bool has_shot() const { return sampled.subtracts(); }
  /// Functions of all measurements (K), then of their total light for differences (2 K).
  BetweenBins::Functions functions_of(const MeasurementTable& table) const;
  void pull_back_functions(const BetweenBins::Functions& gradient,
                           MeasurementTable& by_table) const;

  Camera camera;
  SampledCamera sampled;
  BetweenBins between;
  int exposures;
};

/// At most 64 groups of whole blocks, for any number of threads.
std::int64_t pixels_in_a_group(std::int64_t pixels);

}  // namespace tofsmith

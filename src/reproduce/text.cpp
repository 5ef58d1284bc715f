// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reproduce/figures.hpp"
#include "reproduce/text_statements.hpp"

namespace tofsmith {

Reproduction reproduce_text(const ReproduceContext& context, const Progress& progress) {
  Reproduction result;
  add_convergence(result, context, part_of(progress, 0.0, 0.3));
  add_sinusoids_of_any_k(result, context, part_of(progress, 0.3, 0.4));
  add_kept_bounds(result, context, part_of(progress, 0.4, 0.95));
  add_zero_error_at_p30(result, context, part_of(progress, 0.95, 1.0));
  return result;
}

}  // namespace tofsmith

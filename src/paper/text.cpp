// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/figures.hpp"
#include "paper/text_statements.hpp"

namespace tofsmith {

Reproduction reproduce_text(const ReproduceContext& context, const Progress& progress) {
  const ProgressParts parts(progress, {30, 10, 55, 5});
  Reproduction result;
  add_convergence(result, context, parts[0]);
  add_sinusoids_of_any_k(result, context, parts[1]);
  add_kept_bounds(result, context, parts[2]);
  add_zero_error_at_p30(result, context, parts[3]);
  return result;
}

}  // namespace tofsmith

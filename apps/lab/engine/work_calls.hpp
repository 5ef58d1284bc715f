// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.hpp"
#include "tofsmith/core/progress.hpp"

// Long calls; each corresponds to the command of the same name.
namespace tofsmith::lab {

/// Returns {document: output of `tofsmith evaluate --json`; signal_e_per_s, ambient_e_per_s,
/// error_m, standard_error_m, cramer_rao_mae_m, receiver_bound_mae_m (S, A); notes}. The kind of
/// error is that of the camera's operating range.
Answer evaluate_answer(const Request& request, const Progress& progress);

/// Returns {depth_m, true_depth_m, status, standard_deviation_m (H, W), ...}, as by `tofsmith
/// simulate` and `tofsmith decode --filter` for a built-in scene.
Answer scene_answer(const Request& request, const Progress& progress);

/// Returns {document: output of `tofsmith design --json`; name, file, error_m, explanation,
/// left_out}.
Answer design_answer(const Request& request, const Progress& progress);

/// Returns {command: shell commands that give the same result}.
Answer command_answer(const Request& request);

}  // namespace tofsmith::lab

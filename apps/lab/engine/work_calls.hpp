// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reply.hpp"
#include "request.hpp"
#include "tofsmith/core/progress.hpp"

// The calls that compute for a while, each as the command of its name does.
namespace tofsmith::lab {

/// {document: what `tofsmith evaluate --json` prints; signal_e_per_s, ambient_e_per_s, error_m,
/// standard_error_m, cramer_rao_mae_m, receiver_bound_mae_m (S, A); notes}. The error is that by
/// which the camera is judged.
Answer evaluate_answer(const Request& request, const Progress& progress);

/// {depth_m, true_depth_m, status, standard_deviation_m (H, W), ..}: what `tofsmith simulate` and
/// `tofsmith decode --filter` make of a built-in scene.
Answer scene_answer(const Request& request, const Progress& progress);

/// {document: what `tofsmith design --json` prints; name, file, error_m, explanation, left_out}.
Answer design_answer(const Request& request, const Progress& progress);

/// {command: lines for a shell that give the same result}.
Answer command_answer(const Request& request);

}  // namespace tofsmith::lab

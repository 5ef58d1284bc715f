// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Forward model and decoding table of a code on judged_camera().
struct CodeOnCamera {
  /// @param fitting  must fit the camera and outlive this object
  CodeOnCamera(const CodeSet& fitting, const Camera& given);
  CodeOnCamera(CodeSet&&, const Camera&) = delete;

  const CodeSet& code;
  Camera camera;
  ForwardModel model;
  DecodingTable table;
};

/// Computes the depth error as evaluate(code, camera, options), without bounds.
DepthErrorReport evaluate(const CodeOnCamera& on, const EvaluateOptions& options,
                          const Progress& progress = {});

/// Finds the best rotation as best_rotation(code, camera, options).
BestRotation best_rotation(const CodeOnCamera& on, const EvaluateOptions& options,
                           const Progress& progress = {});

}  // namespace tofsmith

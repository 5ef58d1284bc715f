// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/multipath_scene.hpp"

namespace tofsmith {

/// What `evaluate --multipath` found, as JSON: per code, per signal, every cell; what a code cannot
/// do is null.
/// @param scene  what became of a scene, by mean delay of its later light; null: none
std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options,
                               const MultipathScene* scene = nullptr);

}  // namespace tofsmith

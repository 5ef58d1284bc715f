// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Hash of camera and code without names and light levels.
std::string setup_key(const Camera& camera, const CodeSet& code);
/// @param effort  of the options
std::string setup_key(const Camera& camera, const DesignOptions& options, double effort);

/// Returns WorkItem::key.
/// @param setup  setup_key()
std::string item_key(std::string_view setup, const OperatingRange& light,
                     const EvaluateOptions& options);

}  // namespace tofsmith

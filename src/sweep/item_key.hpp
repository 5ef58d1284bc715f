// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A hash of all of a camera and the code it plays, but for names and light levels.
std::string setup_key(const Camera& camera, const CodeSet& code);
/// The same of a camera for which a code is designed.
/// @param effort  that the options are of
std::string setup_key(const Camera& camera, const DesignOptions& options, double effort);

/// WorkItem::key of what evaluate() is called with.
/// @param setup  setup_key()
std::string item_key(std::string_view setup, const OperatingRange& light,
                     const EvaluateOptions& options);

}  // namespace tofsmith

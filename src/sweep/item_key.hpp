// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// WorkItem::key of what evaluate() is called with.
std::string item_key(const Camera& camera, const CodeSet& code, const EvaluateOptions& options);

}  // namespace tofsmith

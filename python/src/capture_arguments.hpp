// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith::python {

/// Creates a scene from its planes by name, each (H, W) or None.
/// @throws std::invalid_argument naming the invalid plane
SceneImage scene_of(const py::dict& planes);

}  // namespace tofsmith::python

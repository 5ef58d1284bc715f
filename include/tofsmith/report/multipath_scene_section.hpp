// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/multipath_scene.hpp"

namespace tofsmith {

/// The lines of a table of errors by mean delay of the later light, headings first.
std::vector<std::vector<std::string>> multipath_scene_rows(const MultipathScene& scene);

/// True, single-path and two-return depth and errors, where two returns were found, the middle row
/// seen from above, point clouds with and without, and the table.
Section multipath_scene_section(const MultipathScene& scene, const Camera& camera);

}  // namespace tofsmith

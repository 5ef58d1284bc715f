// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Light level, relative to the nominal one, at which rows should still work.
inline constexpr double dim_share = 0.1;

Camera in_share_of_light(Camera camera, double share);

/// Returns a note on how to design for dim light if the winner on a camera that reads rows is
/// significantly worse than a standard code at a tenth of the smallest signal.
std::optional<std::string> dim_light_note(const Camera& camera, const DesignResult& result,
                                          const DesignOptions& options);

}  // namespace tofsmith

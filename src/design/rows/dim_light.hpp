// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Light level, relative to the nominal one, at which rows should also work.
inline constexpr double dim_share = 0.1;

/// Returns the camera with light scaled by `share`.
Camera in_share_of_light(Camera camera, double share);

/// Returns a note if, on a camera that reads rows, the winner has a larger error than a standard
/// code at a tenth of the smallest signal, significantly beyond noise. The note describes how to
/// design rows for that light.
std::optional<std::string> dim_light_note(const Camera& camera, const DesignResult& result,
                                          const DesignOptions& options);

}  // namespace tofsmith

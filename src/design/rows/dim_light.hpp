// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// The dimmer light that rows should hold out in, as a share of what they are asked for.
inline constexpr double dim_share = 0.1;

/// A camera in so many times its light.
Camera in_share_of_light(Camera camera, double share);

/// That the winner on a camera that reads rows errs more than a standard code in a tenth of the
/// dimmest signal, and how to ask for rows that do not; none: it does not, beyond noise.
std::optional<std::string> dim_light_note(const Camera& camera, const DesignResult& result,
                                          const DesignOptions& options);

}  // namespace tofsmith

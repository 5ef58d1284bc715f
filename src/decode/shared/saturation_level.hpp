// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Raw number at which a tap value is clipped, by its well or its converter; none if by neither.
std::optional<float> saturation_level_of(const Sensor& sensor);

}  // namespace tofsmith

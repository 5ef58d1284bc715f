// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reply.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith::lab {

/// Returns {toml, fields, range_m, warnings}: the complete camera, and every key that applies to
/// it.
Answer camera_answer(const Camera& camera);

}  // namespace tofsmith::lab

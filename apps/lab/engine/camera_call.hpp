// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "reply.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith::lab {

/// What a key of a camera's description means, with its unit and rule: the comment beside the field
/// in camera.hpp. "": there is none.
std::string_view doc_of_camera_key(std::string_view key);

/// {toml, fields, range_m, warnings}: the camera whole, and every key that means something on it.
Answer camera_answer(const Camera& camera);

}  // namespace tofsmith::lab

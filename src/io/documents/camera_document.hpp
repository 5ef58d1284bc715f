// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Fills in defaults. @throws std::invalid_argument if the camera is invalid
nlohmann::ordered_json camera_document(const Camera& camera);

}  // namespace tofsmith

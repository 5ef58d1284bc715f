// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "io/text/json_reader.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Uses the keys of a camera file.
nlohmann::ordered_json lens_document(const Lens& lens);

/// Does not check values. @throws IoError naming file and member
Lens lens_from_json(const JsonReader& lens);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace tofsmith {

/// Distance that is written as depth.
enum class DepthKind {
  radial,  ///< along the ray
  z,       ///< along the optical axis
};

constexpr std::array<std::string_view, 2> words_of(DepthKind /*any*/) { return {"radial", "z"}; }
/// "radial", "z".
std::string_view name_of(DepthKind kind);
/// @throws std::invalid_argument for any other word
DepthKind parse_depth_kind(std::string_view name);

}  // namespace tofsmith

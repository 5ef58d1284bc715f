// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Distance that is written as depth.
enum class DepthKind {
  radial,  ///< along the ray
  z,       ///< along the optical axis
};

constexpr auto words_of(DepthKind /*any*/) { return word_list("radial", "z"); }
/// @throws std::invalid_argument for any other word
inline DepthKind parse_depth_kind(std::string_view name) {
  return parse_word<DepthKind>("kind", name);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/images/exr.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

// Depth is radial or z. stored_depth_kind() reads these fields.

void add_depth_kind(DepthKind kind, NpzArrays& arrays);
/// Returns the attribute with the kind of the channel Z.
ExrText exr_text_of(DepthKind kind);

}  // namespace tofsmith

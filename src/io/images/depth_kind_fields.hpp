// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/images/exr.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

// Fields of files that state whether depth is radial or z. stored_depth_kind() reads them.

/// Adds the array with the kind of `depth` to the arrays of an .npz.
void add_depth_kind(DepthKind kind, NpzArrays& arrays);
/// Returns the attribute of an .exr with the kind of its channel Z.
ExrText exr_text_of(DepthKind kind);

}  // namespace tofsmith

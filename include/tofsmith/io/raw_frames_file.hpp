// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "tofsmith/core/array.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Raw measurements of shape (H, W, K), or (F, H, W, K) for several frames, from .npy or .npz (the
/// array "raw", or the only one): uint8, uint16, int16, float32 or float64. Values are kept as they
/// are, NaN and infinity too.
/// @param measurements  K that the code asks for, if one is known
/// @throws IoError if the extension, the shape or the type is another, or K differs
RawFrames read_raw_frames(const std::filesystem::path& path,
                          std::optional<int> measurements = std::nullopt);

/// Writes float32 to .npy or .npz: (H, W, K) if there is one frame, (F, H, W, K) otherwise.
/// @throws std::invalid_argument if there are no values, or not as many as the sizes say
/// @throws IoError if the extension is another, or as AtomicFile does
void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw, OutputPolicy policy);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Returns a note that the raw numbers of a frame do not fit the code of a decoder. It contains
/// their residual, and the orders of exposures or the byte order that fit better. A reversed delay
/// is not detected, because it results in valid measurements of other depths.
///
/// Tries other orders on a sample of the pixels with the most contrast: all permutations of up to 6
/// exposures; for more exposures, permutations of groups of equal size and within the groups.
/// @param frame  recorded frame to sample
/// @return none if the residual is small, or if the code has no degrees of freedom
std::optional<std::string> misfit_note(const DecodeRequest& request, const DepthDecoder& decoder,
                                       const RawFramesReader& reader, int frame);

}  // namespace tofsmith

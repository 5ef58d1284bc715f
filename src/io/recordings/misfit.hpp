// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Returns a note if the raw numbers of a frame do not fit the code, with orders of exposures or
/// byte orders that fit better. A reversed delay is not detected, because it results in valid
/// measurements of other depths.
///
/// Tests the pixels with the most contrast: all permutations of up to 6 exposures; for more
/// exposures, permutations of groups of equal size and within the groups.
/// @param frame  recorded frame to sample
/// @return none if the residual is small, or if the code has no degrees of freedom
std::optional<std::string> misfit_note(const DecodeRequest& request, const DepthDecoder& decoder,
                                       const RawFramesReader& reader, int frame);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/output/output_kernel.hpp"
#include "decode/search/chord_matcher.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// What a Decoder decides by, for what decides likewise on another processor. Lives as long as its
/// decoder, which may be moved.
struct DecoderParts {
  const ChordMatcher& matcher;
  const OutputKernel& outputs;
};
DecoderParts parts_of(const Decoder& decoder);

/// @throws InvalidArgument if raw numbers are no frame, or of another number of measurements
void require_frame(const RawView& raw, int measurements);

}  // namespace tofsmith

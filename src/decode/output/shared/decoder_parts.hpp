// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/output/output_kernel.hpp"
#include "decode/search/chord_matcher.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Parts of a Decoder for other devices. Valid as long as the decoder, even if it is moved.
struct DecoderParts {
  const ChordMatcher& matcher;
  const OutputKernel& outputs;
};
DecoderParts parts_of(const Decoder& decoder);

/// @throws InvalidArgument if `raw` is not a frame or has another number of measurements
void require_frame(const RawView& raw, int measurements);

}  // namespace tofsmith

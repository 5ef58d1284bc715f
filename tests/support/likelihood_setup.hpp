// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode_setup.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"

namespace tofsmith {

using LikelihoodSetup = DecoderSetup<LikelihoodDecoder, DecodeOptions>;

}  // namespace tofsmith

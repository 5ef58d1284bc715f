// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode_setup.hpp"
#include "tofsmith/decode/unwrap_decoder.hpp"

namespace tofsmith {

using UnwrapSetup = DecoderSetup<UnwrapDecoder, UnwrapOptions>;

}  // namespace tofsmith

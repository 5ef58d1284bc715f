// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

/// Value of RAW and OUTPUT that means standard input and output.
inline constexpr std::string_view pipe_word = "-";

/// Implements `decode - ... -o -`: decodes frames from standard input to standard output. Messages
/// go to standard error.
/// @throws UsageError as decode_all(); Interrupted, also while waiting for a frame
void decode_pipe(const DecodeRequest& request, const FrameBackend& backend, Session& session);

}  // namespace tofsmith::apps

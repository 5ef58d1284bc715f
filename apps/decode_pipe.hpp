// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

/// The RAW and OUTPUT that mean standard input and output.
inline constexpr std::string_view pipe_word = "-";

/// `decode - .. -o -`: frames from standard input to standard output, one after another; what there
/// is to say goes to standard error.
/// @throws UsageError as decode_all(); Interrupted, also while it waits for a frame
void decode_pipe(const DecodeRequest& request, const FrameBackend& backend, Session& session);

}  // namespace tofsmith::apps

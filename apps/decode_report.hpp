// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

/// Returns a summary for the terminal: one line per frame (only the first ones if there are many),
/// and one with totals and rate.
std::string decode_lines(const DecodeRequest& request, const DecodedRecording& result);

/// Adds frames, files, status counts and rate to a document. The list of frames is omitted beyond
/// 100,000 frames.
void add_decode_summary(const DecodeRequest& request, const DecodedRecording& result,
                        nlohmann::ordered_json& document);

}  // namespace tofsmith::apps

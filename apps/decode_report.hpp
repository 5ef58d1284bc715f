// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

/// What was written, for people: a line per frame, the first few if there are many, and one with
/// totals and rate.
std::string decode_lines(const DecodeRequest& request, const DecodedRecording& result);

/// Adds the same to a document: frames, files, statuses, rate. Beyond 100 000 frames there is no
/// list of them.
void add_decode_summary(const DecodeRequest& request, const DecodedRecording& result,
                        nlohmann::ordered_json& document);

}  // namespace tofsmith::apps

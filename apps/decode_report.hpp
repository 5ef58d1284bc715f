// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "decode_output.hpp"
#include "decode_stream.hpp"

namespace tofsmith::apps {

/// Where no pixel of any frame has a depth: how many have which status, and what to look at.
std::optional<std::string> no_depth_note(const StatusCounts& statuses);

/// What was written, for people: a line per frame, the first few if there are many, and one with
/// totals and rate.
std::string decode_lines(const DecodeTarget& target, const DecodeSummary& summary);

/// Adds the same to a document: frames, files, statuses, rate. Beyond 100 000 frames there is no
/// list of them.
void add_decode_summary(const DecodeTarget& target, const DecodeSummary& summary,
                        nlohmann::ordered_json& document);

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reply.hpp"

namespace tofsmith::lab {

namespace {

/// Converts JSON to text. Invalid UTF-8 (e.g. in names from files) is replaced; non-finite numbers
/// become null.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

Reply Answer::reply() && {
  return {text_of(Json{{"answer", std::move(json_)}}), std::move(arrays_)};
}

Reply error_reply(std::string_view message, std::string_view field) {
  Json error = {{"message", message}};
  if (!field.empty()) error["field"] = field;
  return {text_of(Json{{"error", std::move(error)}}), {}};
}

}  // namespace tofsmith::lab

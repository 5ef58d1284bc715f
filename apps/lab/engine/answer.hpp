// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "reply.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith::lab {

/// Answers a request of the lab's page: a JSON object with `call` and the call's arguments (see
/// docs/lab.md). The JSON of the reply holds `answer`, or `error` with the message that the command
/// would print; whatever the request is, it is a reply.
/// @param progress  of calls that take long; a design stops where it says so
Reply answer(std::string_view request, const Progress& progress = {});

}  // namespace tofsmith::lab

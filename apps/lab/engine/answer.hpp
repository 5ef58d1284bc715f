// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "request.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith::lab {

/// Answers a request of the lab page: a JSON object with `call` and its arguments (see
/// docs/lab.md). The JSON of the reply contains `answer`, or `error` with the message that the
/// command would print. Invalid requests are answered, too.
/// @param progress  for long calls; can stop a design
Reply answer(std::string_view request, const Progress& progress = {});

}  // namespace tofsmith::lab

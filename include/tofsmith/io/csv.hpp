// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// Returns a text as a CSV field, quoted if necessary (RFC 4180).
std::string csv_field(std::string_view text);

}  // namespace tofsmith

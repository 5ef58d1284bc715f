// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// A file name for something named freely: bytes other than ASCII letters, digits, "-", "_", and
/// dots after the first byte, become %XX. Different names stay different; none leaves its
/// directory.
std::string file_name_of(std::string_view name);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <utility>

namespace tofsmith {

/// The words that stand for the values of an enumeration in files.
template <typename Enum>
using Choices = std::span<const std::pair<std::string_view, Enum>>;

}  // namespace tofsmith

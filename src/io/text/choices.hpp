// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <utility>

namespace tofsmith {

/// A word that stands for a value of an enumeration in files.
template <typename Enum>
using ChoiceWord = std::pair<std::string_view, Enum>;

/// The words for all of its values.
template <typename Enum>
using Choices = std::span<const ChoiceWord<Enum>>;

}  // namespace tofsmith

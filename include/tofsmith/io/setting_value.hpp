// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace tofsmith {

/// What a key of a TOML file can be set to.
struct SettingValue {
  std::string toml;              ///< as the right side of `key = ..`, on one line
  std::string text;              ///< the same without the quotes of a text
  std::optional<double> number;  ///< of an integer or a finite number
  std::string place;             ///< where it was written, as errors name it
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <string>

#include "tofsmith/io/setting_value.hpp"

namespace tofsmith {

/// A value taken out of a TOML file.
SettingValue toml_value_of(const toml::node& node, std::string place);

/// A number as TOML writes it: whole ones as integers.
SettingValue toml_value_of(double number, std::string place);

/// What a line of a file holds: a number, or else a text.
SettingValue toml_value_of_line(const std::string& line, std::string place);

}  // namespace tofsmith

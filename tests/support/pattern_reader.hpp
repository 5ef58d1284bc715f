// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace tofsmith {

enum class PatternSyntax { coe, mif, mem, systemverilog, vhdl, c };

struct PatternWords {
  int word_bits = 0;  ///< 0 if the file does not contain it (.coe, .mem)
  std::vector<std::uint64_t> words;
};

/// Reads the files written by pattern_memory.hpp, and .coe, .mif and .mem files of other tools (any
/// radix, address ranges, comments).
/// @param file  name for error messages
/// @throws IoError "file: ..." for any other text
PatternWords parse_pattern(std::string_view text, PatternSyntax syntax, std::string_view file);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// What separates whole from fraction in a text of numbers.
enum class DecimalMark { automatic, point, comma };

constexpr std::array<std::string_view, 3> words_of(DecimalMark /*any*/) {
  return {"auto", "point", "comma"};
}
/// "auto", "point" or "comma". @throws std::invalid_argument for any other word
DecimalMark parse_decimal_mark(std::string_view word);

/// A table of numbers as an instrument wrote it.
struct InstrumentTable {
  std::vector<std::string> names;  ///< of the columns; empty when the file does not say
  Eigen::MatrixXd values;          ///< (rows, columns), finite
  std::vector<std::size_t> lines;  ///< of the file, counted from 1, for every row
  std::vector<std::string> notes;  ///< what the user should know of how it was read
};

/// Reads what oscilloscopes, counters and spreadsheets write: columns between tabs, semicolons,
/// commas or blanks, with decimal points or commas, after any number of lines of text (the last of
/// which may name the columns). What separates is found by reading the file each way; a file that
/// can be read in two ways, such as lines of "1,5", is refused unless its header or rising whole
/// numbers settle it. Empty lines and lines that begin with '#' are skipped.
/// @param file  what errors call it
/// @throws IoError "file:line: .." for what is no finite number, rows of different lengths, no row
///         at all, or a meaning that is open
InstrumentTable parse_instrument_table(std::string_view text, std::string_view file,
                                       DecimalMark decimal = DecimalMark::automatic);
InstrumentTable read_instrument_table(const std::filesystem::path& path,
                                      DecimalMark decimal = DecimalMark::automatic);

/// Seconds per unit of a column's name: "time_ns", "Time (us)", "delay [ps]", "second"; 0 if the
/// name does not say.
double seconds_per_unit(std::string_view column_name);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace tofsmith {

inline constexpr int max_cell_rank = 4;
/// More directions take too long to prove; a record could count 32767.
inline constexpr std::int32_t max_cell_directions = 16384;

/// A run of neighbouring directions that may win in a cell of the sphere, among which the score has
/// one peak; or, for a cell with several such runs or without a useful fit, where its records are.
struct CellRecord {
  static constexpr std::uint16_t no_rival = 0xffff;
  static constexpr std::int16_t no_proof = 0x7fff;
  static constexpr std::uint16_t several = 0x8000;
  static constexpr double slack_unit = 1.0 / 16384;
  /// How far cells reach beyond their sides, in units of c (see CellTable).
  static constexpr double overlap = 2e-5;

  std::uint16_t first = 0;   ///< lowest direction of the run, in [0, M)
  std::uint16_t length = 0;  ///< directions after it, through M to 0; or several
  /// Winner after first, as a real number: x = [0] + sum_s [s] t_s, in units of the table. Cells of
  /// rank 3 hold their slack in the last one.
  std::array<std::int16_t, max_cell_rank> fit{};
  std::uint16_t rival = no_rival;  ///< bin that scores best outside the main lobe, at the centre
  /// In units of slack_unit: x is right wherever it is further than this from half-way between two
  /// directions; no_proof (only in lists): nowhere.
  std::int16_t slack = no_proof;

  bool is_list() const { return (length & several) != 0; }
  /// Of a list: index of its first record, and their number.
  std::uint32_t list_begin() const;
  std::uint32_t list_length() const { return length & (several - 1u); }
  static CellRecord list(std::uint32_t begin, std::uint32_t count);
  /// The rival in a record's last word; -1 where there is none.
  static std::int32_t rival_in(std::int32_t word) {
    const std::int32_t rival = word & 0xffff;
    return rival == no_rival ? -1 : rival;
  }
};
static_assert(sizeof(CellRecord) == 16);

}  // namespace tofsmith

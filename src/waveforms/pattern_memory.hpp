// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// Bits of a word that drive one output.
struct PatternField {
  std::string name;   ///< "light", "tap_1", .., "trigger"
  int first_bit = 0;  ///< lowest, bit 0 is the least significant
  int bits = 1;

  friend bool operator==(const PatternField&, const PatternField&) = default;
};

/// The words that an FPGA plays, one per clock, one exposure after another: the word of point j of
/// exposure e stands at e x points_per_exposure + j.
struct PatternMemory {
  std::string name = "pattern";  ///< of the table in a language, letters, digits and _
  std::string comment;           ///< lines for people, put on top of the file
  int word_bits = 1;             ///< 1 .. 64
  int points_per_exposure = 0;   ///< of all periods that the memory holds
  std::vector<PatternField> fields;
  std::vector<std::uint64_t> words;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Light in the lowest bits, then each tap, and on top the trigger: as many bits per output as
/// their levels need. All waveforms need the same levels and points.
/// @param waveforms  modulation of every exposure, demodulation of every tap value or, of taps
///                   that share a generator, of the first of every exposure
/// @throws std::invalid_argument if they differ, are of no power of two of levels, or need more
///         than 64 bits
PatternMemory pattern_memory(std::span<const QuantizedWaveform> waveforms, int exposures,
                             std::string comment);

/// The codes of one field, point by point, all exposures one after another.
std::vector<std::int32_t> codes_of(const PatternMemory& memory, const PatternField& field);

/// Xilinx coefficient file.
std::string xilinx_coe(const PatternMemory& memory);
/// Intel (Altera) memory initialization file.
std::string intel_mif(const PatternMemory& memory);
/// For Verilog's $readmemh.
std::string verilog_mem(const PatternMemory& memory);
/// A package with the words as a constant table.
std::string systemverilog_package(const PatternMemory& memory);
std::string vhdl_package(const PatternMemory& memory);
/// A C99 header.
std::string c_header(const PatternMemory& memory);

}  // namespace tofsmith

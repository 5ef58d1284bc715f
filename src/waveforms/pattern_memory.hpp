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
  std::string name;   ///< "light", "tap_1", ..., "trigger"
  int first_bit = 0;  ///< lowest bit; bit 0 is the least significant
  int bits = 1;

  friend bool operator==(const PatternField&, const PatternField&) = default;
};

/// The words that an FPGA outputs, one per clock, one exposure after another. Point j of exposure e
/// is word e x points_per_exposure + j.
struct PatternMemory {
  std::string name = "pattern";  ///< of the table in source code; letters, digits and _
  std::string comment;           ///< written at the top of the file
  int word_bits = 1;             ///< 1 to 64
  int points_per_exposure = 0;   ///< over all periods in the memory
  std::vector<PatternField> fields;
  std::vector<std::uint64_t> words;

  /// @throws std::invalid_argument
  void validate() const;
};

/// Packs outputs into words: light in the lowest bits, then the taps, then the trigger. The number
/// of bits per output follows from the levels. All waveforms must have the same levels and points.
/// @param waveforms  modulation of every exposure, then demodulation of every tap value (if taps
///                   share a generator, only the first of each exposure)
/// @throws std::invalid_argument if the waveforms differ, the levels are not a power of two, or a
///         word needs more than 64 bits
PatternMemory pattern_memory(std::span<const QuantizedWaveform> waveforms, int exposures,
                             std::string comment);

/// Returns the codes of one field, point by point, one exposure after another.
std::vector<std::int32_t> codes_of(const PatternMemory& memory, const PatternField& field);

/// Xilinx coefficient file.
std::string xilinx_coe(const PatternMemory& memory);
/// Intel (Altera) memory initialization file.
std::string intel_mif(const PatternMemory& memory);
/// File for Verilog's $readmemh.
std::string verilog_mem(const PatternMemory& memory);
/// Package with the words as a constant table.
std::string systemverilog_package(const PatternMemory& memory);
std::string vhdl_package(const PatternMemory& memory);
/// C99 header.
std::string c_header(const PatternMemory& memory);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
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

/// Words that an FPGA outputs, one per clock. Point j of exposure e is word e x points_per_exposure
/// + j.
struct PatternMemory {
  std::string name = "pattern";  ///< in source code; letters, digits and _
  std::string comment;
  int word_bits = 1;            ///< 1 to 64
  int points_per_exposure = 0;  ///< over all periods in the memory
  std::vector<PatternField> fields;
  std::vector<std::uint64_t> words;

  /// @throws std::invalid_argument
  void validate() const;
};

/// Packs outputs into words: light in the lowest bits, then the taps, then the trigger. The levels,
/// which all waveforms share, determine the bits per output.
/// @param waveforms  modulation of every exposure, then demodulation of every tap value (if taps
///   share a generator, only the first of each exposure)
/// @throws std::invalid_argument if the waveforms differ, the levels are not a power of two, or a
///   word needs more than 64 bits
PatternMemory pattern_memory(std::span<const QuantizedWaveform> waveforms, int exposures,
                             std::string comment);

/// Coefficient file.
std::string xilinx_coe(const PatternMemory& memory);
/// Intel (Altera) memory initialization file.
std::string intel_mif(const PatternMemory& memory);
/// For $readmemh.
std::string verilog_mem(const PatternMemory& memory);
std::string systemverilog_package(const PatternMemory& memory);
std::string vhdl_package(const PatternMemory& memory);
/// C99 header.
std::string c_header(const PatternMemory& memory);

}  // namespace tofsmith

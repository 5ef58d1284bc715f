// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// What the DAC of an AFG takes: 0 .. 16382. (Some sources go to 16383: docs/formats.md.)
inline constexpr std::int32_t tektronix_afg_levels = 16383;
inline constexpr std::int32_t tektronix_afg_full_levels = 16384;

/// Points as an AFG keeps them and as its TRACe:DATA takes them: big-endian 16-bit numbers.
/// @throws std::invalid_argument if the waveform is invalid or has more than 2^14 levels
std::vector<std::byte> tektronix_afg_bytes(const QuantizedWaveform& waveform);
/// A .tfw file of AFG1000 to AFG31000: 512 bytes of header with a picture of the waveform, then the
/// points. It holds shape only: frequency and voltages are set on the generator.
/// @throws std::invalid_argument as tektronix_afg_bytes()
std::vector<std::byte> tektronix_tfw(const QuantizedWaveform& waveform);
/// A .wfm file ("MAGIC 1000") of AWG400, AWG500, AWG600 and AWG700, read by AWG5000 and AWG7000
/// too: per point a little-endian float and a byte of markers. Marker 1 is the trigger of every
/// period, marker 2 the first point.
/// @param end_of_line  "\r\n", or "\n", or " \r\n": sources disagree
/// @throws std::invalid_argument if the waveform is invalid
std::vector<std::byte> tektronix_wfm(const QuantizedWaveform& waveform,
                                     std::string_view end_of_line = "\r\n");

}  // namespace tofsmith

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

/// 0 to 16382. (Some sources use 16383: docs/formats.md.)
inline constexpr std::int32_t tektronix_afg_levels = 16383;
inline constexpr std::int32_t tektronix_afg_full_levels = 16384;

/// Returns a .tfw file for AFG1000 to AFG31000: a header of 512 bytes with a preview, then the
/// points, without frequency and voltages.
/// @throws std::invalid_argument if the waveform is invalid or has more than 2^14 levels
std::vector<std::byte> tektronix_tfw(const QuantizedWaveform& waveform);
/// Returns a .wfm file ("MAGIC 1000") for AWG400 to AWG700, AWG5000 and AWG7000: points as
/// little-endian floats with a byte of markers. Marker 1 is the trigger of every period, marker 2
/// the first point.
/// @param end_of_line  "\r\n", "\n" or " \r\n"; sources disagree
/// @throws std::invalid_argument if the waveform is invalid
std::vector<std::byte> tektronix_wfm(const QuantizedWaveform& waveform,
                                     std::string_view end_of_line = "\r\n");

}  // namespace tofsmith

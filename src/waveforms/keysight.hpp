// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// Levels of the DAC of a 33500 or 33600, -32767 to 32767.
inline constexpr std::int32_t keysight_levels = 65535;

/// Returns an .arb file for a 33500 or 33600.
/// @param end_of_line  "\n" or "\r\n"
/// @throws std::invalid_argument if the waveform is invalid or does not have `keysight_levels`
std::string keysight_arb_text(const QuantizedWaveform& waveform,
                              std::string_view end_of_line = "\n");
/// Points for DATA:ARB:DAC: big-endian 16-bit numbers (the default of FORM:BORD).
/// @throws std::invalid_argument as keysight_arb_text()
std::vector<std::byte> keysight_dac_bytes(const QuantizedWaveform& waveform);

}  // namespace tofsmith

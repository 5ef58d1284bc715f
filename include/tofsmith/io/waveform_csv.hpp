// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// The waveforms of a code as a table for a waveform generator, one row per time sample:
///   time_s, modulation_1 .. modulation_E (power over average), demodulation_1 .. demodulation_K
/// A sample is the mean over its cell, so that duties are exact.
std::string waveforms_to_csv(const CodeSet& code, double fundamental_frequency_hz);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

TEST(WaveformsToCsv, HasOneRowPerSampleAndOneColumnPerWaveform) {
  const CodeSet code = CodeSet::create("x", 4, 2, {Waveform::binary({{0.0, 0.375}}, 2.0)},
                                       {square_wave(1, 0.0), square_wave(1, 0.5)});
  EXPECT_EQ(waveforms_to_csv(code, 10e6),
            "time_s,modulation_1,demodulation_1,demodulation_2\n"
            "0,2,1,0\n"
            "2.5e-08,1,1,0\n"
            "5e-08,0,0,1\n"
            "7.5e-08,0,0,1\n");
}

}  // namespace
}  // namespace tofsmith

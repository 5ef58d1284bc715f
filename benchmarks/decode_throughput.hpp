// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "asked_figures.hpp"
#include "decode_frame.hpp"
#include "reference_bins.hpp"

namespace tofsmith::benchmarks {

/// Compares all decoders for one code at one N.
class DecodeThroughput {
 public:
  DecodeThroughput(const DecodeCode& code, int samples);

  /// Prints one line for a frame on one core and adds the targets.
  void print(Scene scene, const LightLevel& light, int rounds, AskedFigures& asked) const;
  static void print_heading();

 private:
  const DecodeCode& code_;
  DecodingTable table_;
  Decoder decoder_;
  ReferenceCurve curve_;
};

}  // namespace tofsmith::benchmarks

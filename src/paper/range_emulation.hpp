// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

/// A pixel that sees one target, and how its depth is made to vary.
struct RangeEmulationOptions {
  double target_m = 0.7;              ///< true distance of the target [m], >= 0; wraps at the range
  int shifts = 20;                    ///< delays of the modulation, evenly over the period, >= 1
  int estimates = 300;                ///< measurements of the pixel for each delay, >= 2
  OperatingPoint point = {1e5, 1e3};  ///< light that the pixel sees, the same for every delay
  std::uint64_t seed = 1;             ///< of all noise
  DecodeMethod method = DecodeMethod::zncc;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// What the pixel measures behind one delay.
struct EmulatedDepth {
  double true_m = 0.0;      ///< target + j range / shifts, modulo range
  Estimate mean_error_m;    ///< mean of decoded - true, the shorter way round the range
  Estimate linear_mde_m;    ///< mean |decoded - true|
  Estimate circular_mde_m;  ///< mean of the shorter way round the range
};

struct RangeEmulation {
  double range_m = 0.0;
  std::vector<EmulatedDepth> depths;      ///< one per delay, in their order
  Estimate linear_mde_m, circular_mde_m;  ///< means over the delays

  /// A depth error in percent of the range.
  Estimate percent_of_range(const Estimate& error_m) const;
};

/// The emulation of a large depth range with a target that stays where it is: the modulation is
/// delayed by j / shifts of the period, j = 0 .. shifts - 1, which is as if the target stood
/// j range / shifts farther away, with the light of where it is.
///
/// The waveform that the generator really plays is delayed, by exactly that much: its clock's phase
/// can be set far finer than its points. chi of a delayed modulation is chi(z + delay), so this is
/// what the model says at the emulated depth.
/// @throws std::invalid_argument if camera or options are invalid or the code does not fit;
///         Interrupted if progress says so
/// @note noise depends on (seed, delay, estimate) alone: same bits for any number of threads, and
///       codes of as many measurements are compared on the same noise
/// @see Gutierrez-Barragan et al., CVPR 2019, Fig. 9
RangeEmulation emulate_range(const CodeSet& code, const Camera& camera,
                             const RangeEmulationOptions& options = {},
                             const Progress& progress = {});

}  // namespace tofsmith

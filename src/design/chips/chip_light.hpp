// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Electrons of one operating point in the units of chips: a tap that light of level L falls on
/// during c chips, and that is open for d, expects
///   signal_e L c + ambient_e d   with variance   that + constant_e2.
struct ChipLight {
  double signal_e = 0.0;
  double ambient_e = 0.0;
  double constant_e2 = 0.0;
  double peak_factor = 1.0;
  int chips = 0;
  double chip_m = 0.0;  ///< depth of one chip [m]

  /// @throws std::invalid_argument if the camera has what codes on a chip clock do not allow for
  ChipLight(const Camera& camera, const OperatingPoint& point, int chips, int exposures);

  /// Electrons per chip of light of a modulation.
  double electrons_of(int on_chips) const {
    return signal_e * chip_level(on_chips, chips, peak_factor);
  }
};

/// What a camera, a valid one, has that the model of chips leaves out.
std::optional<BrokenRule> why_not_plain(const Camera& camera);

/// @throws std::invalid_argument for a bad camera, or one with what the model of chips leaves out
void require_plain(const Camera& camera);

}  // namespace tofsmith

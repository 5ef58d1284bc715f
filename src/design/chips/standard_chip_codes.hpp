// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Multi-phase square codes of exclusive taps: in every exposure the taps open one after the other
/// for equal times, over and over with a period that divides the clock's, and the light is on for
/// part of the same period. All combinations of periods of the exposures (coprime ones among
/// them) and of light on for as long as a tap, or half the period; ambiguous ones left out.
std::vector<ChipCode> multi_phase_codes(int chips, int taps, int exposures);

/// A code to compare with, and how many taps the camera must have to play it.
struct StandardCode {
  std::string name;
  CodeSet code;
};

/// What a camera with exclusive taps plays if nobody searches, at peak light:
///   hamiltonian-k3-in-turn  three exposures with one tap each, a pulse of 1/6 (its taps overlap)
///   three-phase-square      one exposure, taps and light a third of the period each
///   double-ramp-in-turn     three exposures with one tap each: rising ramp, falling ramp, no light
///   coprime-three-phase     two exposures of three taps, periods of 1/3 and 1/4
/// @param samples  a multiple of 36
/// @throws std::invalid_argument for other samples
std::vector<StandardCode> standard_chip_codes(const Camera& camera, int samples);

}  // namespace tofsmith

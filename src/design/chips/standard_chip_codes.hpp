// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/simulate/depth_error.hpp"

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

/// How well a code does on a camera at one operating point.
struct ComparedCode {
  std::string name;
  int exposures = 0, taps = 0;
  double rms_m = 0.0;       ///< root mean square over depth of CramerRaoBound::sigma_m
  Estimate circular_mde_m;  ///< Monte Carlo, maximum likelihood
};

/// Every code on the camera, with as many taps and samples as the code has, at each of its
/// operating points: (points, codes).
/// @param options  of the trials; the method is maximum likelihood whatever they say
/// @throws std::invalid_argument if a code does not fit; Interrupted
std::vector<std::vector<ComparedCode>> compare_chip_codes(const std::vector<StandardCode>& codes,
                                                          const Camera& camera,
                                                          EvaluateOptions options = {},
                                                          const Progress& progress = {});

}  // namespace tofsmith

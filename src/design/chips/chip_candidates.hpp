// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns all unambiguous multi-phase square codes for exclusive taps: taps open in turn for equal
/// times, with a period that divides the number of chips; light is on as long as one tap, or half
/// the period.
std::vector<ChipCode> multi_phase_codes(int chips, int taps, int exposures);

struct StandardCode {
  std::string name;
  CodeSet code;
};

/// Returns standard codes for cameras with exclusive taps, at peak light:
///   hamiltonian-k3-in-turn  three exposures of one tap, pulse of 1/6 (overlapping taps)
///   three-phase-square      one exposure, taps and light on for 1/3 of the period each
///   double-ramp-in-turn     three exposures of one tap: rising ramp, falling ramp, no light
///   coprime-three-phase     two exposures of three taps, periods of 1/3 and 1/4
/// @throws std::invalid_argument if samples is not a multiple of 36
std::vector<StandardCode> standard_chip_codes(const Camera& camera, int samples);

std::optional<BrokenRule> why_nothing_to_search(const Camera& camera, const DesignOptions& options);

std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options);

std::string searched_name(int exposures);

/// Searches the codes with the best metric; empty if every code is ambiguous.
/// @throws std::invalid_argument as search_chip_codes(); Interrupted
std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith

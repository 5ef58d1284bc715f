// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the highest harmonic at which both arms together have a gain of at least 1/25 (1/5 per
/// arm in the paper); 0 without band limit.
int useful_harmonics(const Camera& camera);

bool has_same_waveforms(const CodeSet& a, const CodeSet& b);

/// Records in one line per reason why codes do not compete.
void leave_out(DesignResult& result, const std::string& name, const std::string& reason);

/// Adds families, standard codes and the naive code of every target; without explicit baselines,
/// the best of all families by a quick screening.
void add_baselines(const Camera& camera, const DesignOptions& options,
                   const std::vector<TargetSet>& targets, DesignResult& result);

/// Returns the built-in codes, except suggested_baselines(), with up to 10 measurements and
/// frequencies within the bandwidth, at most 30 f0. Empty for three or more taps.
std::vector<std::string> other_families(const Camera& camera, const DesignOptions& options);

/// Returns the error of a code by few trials with the random numbers of searches [m], circular or
/// linear at the best origin, as selected by the camera; circular with operating.interference;
/// infinite if the code determines no depth.
/// @param more  times the usual number of trials
double tried_error_m(const CodeSet& code, const Camera& camera, const DesignOptions& options,
                     int more = 1);

/// Codes that may be the best on a camera, and reasons that exclude others.
struct Contenders {
  std::vector<CodeSet> codes;  ///< best first
  std::map<std::string, std::vector<std::string>> left_out;
};

/// Returns up to eight families that a quick screening does not find clearly worse.
Contenders contending_families(const std::vector<std::string>& names, const Camera& camera,
                               std::uint64_t seed);

/// Returns the best codes of the nearest atlas cameras by a quick screening, best first, up to
/// three per number of exposures. Empty if the options disable the atlas.
/// @param trials  per operating point; none: 25000 in total, at least 1000 each
Contenders contending_atlas_codes(const Camera& camera, const DesignOptions& options,
                                  std::optional<int> trials = {});

/// Adds the best four as candidates and records which codes cannot compete.
void add_atlas_codes(const Contenders& contenders, DesignResult& result);

}  // namespace tofsmith

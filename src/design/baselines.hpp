// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Notes why something does not compete, once for all that share the reason.
void leave_out(DesignResult& result, const std::string& name, const std::string& reason);

/// Codes that compete as they are: families, what a sensor of exclusive taps plays if nobody
/// searches, and the naive code of every target. Where nobody says which families, all do
/// (other_families()), though few trials choose those that are judged.
void add_baselines(const Camera& camera, const DesignOptions& options,
                   const std::vector<TargetSet>& targets, DesignResult& result);

/// Names of all built-in codes beside suggested_baselines(), of up to 10 measurements and
/// frequencies that the band passes, 30 f0 at most; none for three taps or more.
std::vector<std::string> other_families(const Camera& camera, const DesignOptions& options);

/// Codes that may be the best on a camera, and why others are not among them.
struct Contenders {
  std::vector<CodeSet> codes;                                ///< the best first
  std::map<std::string, std::vector<std::string>> left_out;  ///< names by reason
};

/// Of families, those that few trials do not find clearly worse than the best, eight at most.
Contenders contending_families(const std::vector<std::string>& names, const Camera& camera,
                               std::uint64_t seed);

/// The codes of the nearest cameras of the atlas that have the least errors by few trials, best
/// first, at most three of each number of exposures; none where options ask for none.
Contenders contending_atlas_codes(const Camera& camera, const DesignOptions& options);

/// Adds the best four of them as candidates, and notes which cannot compete.
void add_atlas_codes(const Contenders& contenders, DesignResult& result);

}  // namespace tofsmith

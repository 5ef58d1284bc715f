// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/design/chip_code.hpp"

namespace tofsmith {

/// How codes on a chip clock are searched.
struct ChipSearchOptions {
  int exposures = 1;  ///< E, 1 .. 4; with the camera's taps at least 3 measurements, at most 16
  double margin_sigma = 8.0;  ///< least distance of depths apart, in noise [sigma], >= 0
  /// How far apart depths are that must keep the margin [periods], in (0, 1/2): a quarter chip of
  /// nine.
  double separation_periods = 1.0 / 36.0;
  bool equal_duty = true;  ///< the taps of an exposure are open equally long
  /// Codes, after symmetry, up to which all are searched; beyond, codes are annealed without proof.
  /// One of three taps of equal duty in one exposure counts 1, another 20, for the time it takes.
  double largest_exhaustive = 3e11;
  int finalists = 4;                     ///< best codes by the metric to keep, 1 .. 100
  int annealing_starts = 24;             ///< where not all codes are searched; 0 .. 10000
  std::int64_t annealing_steps = 20000;  ///< per start, >= 1
  std::uint64_t seed = 1;                ///< of annealing

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<ChipSearchOptions> auto& o) {
  return std::tuple(
      Field("exposures", o.exposures, "in [1, 4]", Mark::from_above),
      Field("margin_sigma", o.margin_sigma, "finite and >= 0"),
      Field("separation_periods", o.separation_periods, "in (0, 1/2)"),
      Field("equal_duty", o.equal_duty), Field("largest_exhaustive", o.largest_exhaustive, ">= 0"),
      Field("finalists", o.finalists, "in [1, 100]"),
      Field("annealing_starts", o.annealing_starts, "in [0, 10000]", ByEffort{2}),
      Field("annealing_steps", o.annealing_steps, ">= 1"), Field("seed", o.seed, Mark::from_above));
}

/// What became of all codes. Each was dropped by the first test named that it failed.
struct ChipSearchCounts {
  double raw = 0.0;  ///< codes there are: words of light and taps
  double after_symmetry =
      0.0;                    ///< of these, none a delay, a mirror image or a reordering of another
  std::int64_t examined = 0;  ///< really looked at, a few symmetric ones twice
  std::int64_t pruned_by_turning = 0;  ///< three taps: not once around, one way (exact)
  std::int64_t pruned_by_bound = 0;    ///< a bound on their metric is worse than the best
  std::int64_t metric_evaluations = 0;
  std::int64_t pruned_by_metric = 0;
  std::int64_t ambiguous = 0;     ///< exact integer test
  std::int64_t below_margin = 0;  ///< closer than margin_sigma
  std::int64_t kept = 0;          ///< better than the best so far, when looked at

  ChipSearchCounts& operator+=(const ChipSearchCounts& other);
};

/// A new best code.
struct ChipImprovement {
  ChipCode code;
  double rms_m = 0.0;
  double share = 0.0;  ///< of the search, when it was found
};

/// A code that came out of the search.
struct ChipFinalist {
  ChipCode code;
  double rms_m = 0.0;  ///< metric: geometric mean over the points of chip_metric_rms_m
  double margin_sigma =
      0.0;  ///< proven, at the point where it is the smallest share of what is asked
};

/// What the search did.
struct ChipSearchLog {
  ChipSearchCounts counts;
  std::vector<ChipImprovement> improvements;
  std::vector<double> margin_sigma;  ///< asked at every operating point
  double seconds = 0.0;
};

/// The best codes there are on a camera's chip clock.
struct ChipSearchResult {
  std::vector<ChipFinalist>
      finalists;        ///< best first by the metric; judge() says who wins in noise
  bool proved = false;  ///< whether no code has a better metric than the finalists
  std::string proof;    ///< what is proven, or why it is not, in a sentence or two
  ChipSearchLog log;
};

/// What keeps codes of so many exposures from being searched for a camera, a valid one: no chip
/// clock, too few or too many measurements, or what chip_metric_rms_m leaves out.
std::optional<BrokenRule> why_not_searchable(const Camera& camera, int exposures);

/// Searches modulations and tap assignments of a camera with a chip clock for the least geometric
/// mean over its operating points of chip_metric_rms_m, among codes that are not ambiguous and keep
/// the margin at every point. (Where no standard code keeps it, as the one that comes nearest
/// does.) All codes are tried, up to symmetry, and the result is proven, where there are not too
/// many; else codes are annealed from multi-phase squares and the result is not proven.
/// @throws std::invalid_argument for bad options or camera, or as why_not_searchable(); Interrupted
/// @note the same result and counts for any number of threads
/// @see docs/exhaustive_search.md
ChipSearchResult search_chip_codes(const Camera& camera, const ChipSearchOptions& options = {},
                                   const Progress& progress = {});

}  // namespace tofsmith

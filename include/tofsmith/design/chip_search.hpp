// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Binary waveform on a chip clock; bit k: on during chip k.
using ChipWord = std::uint32_t;

/// Per period.
inline constexpr int max_chips = 24;

/// Returns the word delayed cyclically.
ChipWord delayed_chips(ChipWord word, int shift, int chips);
/// Returns the word reversed in time: chip k becomes chip -k.
ChipWord reversed_chips(ChipWord word, int chips);
constexpr ChipWord all_chips(int chips) { return (ChipWord{1} << chips) - 1; }
/// "110": three chips, on during the first two.
std::string chip_text(ChipWord word, int chips);
/// Inverse of chip_text(). @throws InvalidArgument for other characters or lengths
ChipWord chip_word(std::string_view text);

/// Code of binary waveforms on a chip clock. At most one tap of an exposure is open at a time.
struct ChipCode {
  int chips = 0;                       ///< n, per period
  int taps = 0;                        ///< t, per exposure
  std::vector<ChipWord> modulation;    ///< (E)
  std::vector<ChipWord> demodulation;  ///< (E x t), grouped by exposure

  int exposures() const { return static_cast<int>(modulation.size()); }
  int measurements() const { return static_cast<int>(demodulation.size()); }
  /// Words of the taps of an exposure.
  const ChipWord* taps_of(int exposure) const;
  /// chi at a depth of `shift` chips: the number of chips with light on the open tap.
  int correlation(int measurement, int shift) const;
  /// "M 110000 D 110000/001100/000011", with ", " between exposures.
  std::string text() const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const ChipCode&, const ChipCode&) = default;
};

/// Returns why a camera has no chip clock; none if its period is 3 to max_chips times its shortest
/// pulse.
std::optional<BrokenRule> why_no_chip_clock(const Camera& camera);

/// Returns the chips per period: period / sensor.shortest_pulse_s.
/// @throws InvalidArgument as why_no_chip_clock()
int chips_of(const Camera& camera);

/// Returns the level of a modulation that is on for `on_chips`, over average power: the peak
/// factor, or less if the average power requires it. With a peak factor of 1, S is the rate at peak
/// light.
double chip_level(int on_chips, int chips, double peak_factor);

/// Converts the code to the levels and samples of the camera.
CodeSet to_code_set(const ChipCode& code, const Camera& camera, const std::string& name);

/// Variance of depth that the search minimizes.
enum class ChipMetric {
  /// Variance of depth that is estimated together with signal and ambient light.
  unknown_light,
  /// The same with known signal and ambient light, which no camera reaches; for comparison with
  /// "Revisiting Optimal Coding for I-ToF under Practical Sensor Constraints" (CVPR 2026).
  known_light,
};
constexpr auto words_of(ChipMetric /*any*/) { return word_list("unknown-light", "known-light"); }

struct ChipSearchOptions {
  int exposures = 1;  ///< E; 3 to 16 measurements with the camera's taps
  double margin_sigma = 8.0;
  double separation_periods = 1.0 / 36.0;  ///< a quarter of a chip at 9 chips per period
  bool equal_duty = true;
  ChipMetric metric = ChipMetric::unknown_light;
  /// A code with one exposure and three taps of equal duty counts as 1. Others count as 20, because
  /// they take 20 times as long.
  double max_exhaustive = 3e11;
  int finalists = 4;
  int annealing_starts = 24;
  std::int64_t annealing_steps = 20000;
  std::uint64_t seed = 1;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<ChipSearchOptions> auto& o) {
  return std::tuple(
      Field("exposures", o.exposures, closed(1, 4), FieldMark::from_above, Help{"exposures"}),
      Field("margin_sigma", o.margin_sigma, at_least(0),
            Help{"smallest distance between depths, in units of noise"}),
      Field("separation_periods", o.separation_periods, open(0, 0.5),
            Help{"distance from which on depths must keep the margin"}),
      Field("equal_duty", o.equal_duty, Help{"open all taps of an exposure equally long"}),
      Field("metric", o.metric,
            Help{"minimized variance of the depth: with unknown signal and ambient light "
                 "(unknown-light), or with known signal and ambient light (known-light)"}),
      Field("max_exhaustive", o.max_exhaustive, at_least(0).or_infinity(),
            Help{"maximum size of an exhaustive search, up to symmetry; larger ones use annealing, "
                 "without proof"}),
      Field("finalists", o.finalists, closed(1, 100), Help{"number of best codes to keep"}),
      Field("annealing_starts", o.annealing_starts, closed(0, 10000), ByEffort{2},
            Help{"starts of annealing"}),
      Field("annealing_steps", o.annealing_steps, at_least(1), Help{"steps per start"}),
      Field("seed", o.seed, FieldMark::from_above, Help{"seed of annealing"}));
}

/// Dropped codes count for the first test that they failed.
struct ChipSearchCounts {
  double raw = 0.0;                    ///< all words of light and taps
  double after_symmetry = 0.0;         ///< distinct up to symmetry
  std::int64_t examined = 0;           ///< a few symmetric codes twice
  std::int64_t pruned_by_turning = 0;  ///< three taps: not one turn in one sense (exact)
  std::int64_t pruned_by_bound = 0;    ///< lower bound on the metric
  std::int64_t metric_evaluations = 0;
  std::int64_t pruned_by_metric = 0;
  std::int64_t ambiguous = 0;     ///< by an exact integer test
  std::int64_t below_margin = 0;  ///< depths closer than margin_sigma
  std::int64_t kept = 0;

  ChipSearchCounts& operator+=(const ChipSearchCounts& other);
};

struct ChipImprovement {
  ChipCode code;
  double rms_m = 0.0;
  double share = 0.0;  ///< completed fraction of the search
};

struct ChipFinalist {
  ChipCode code;
  double rms_m = 0.0;         ///< root of the minimized variance, geometric mean over the points
  double margin_sigma = 0.0;  ///< proven, where it is smallest relative to the requirement
};

struct ChipSearchLog {
  ChipSearchCounts counts;
  std::vector<ChipImprovement> improvements;
  std::vector<double> margin_sigma;  ///< required per operating point
  double seconds = 0.0;
};

/// Result of search_chip_codes().
struct ChipSearchResult {
  std::vector<ChipFinalist> finalists;  ///< best first by the metric
  bool proved = false;                  ///< no code has a better metric
  std::string proof;                    ///< statement, or why there is none
  ChipSearchLog log;
};

/// Returns why codes of a valid camera cannot be searched; none if they can.
std::optional<BrokenRule> why_not_searchable(const Camera& camera, int exposures);

/// Searches modulations and tap assignments on the camera's chip clock. Minimizes the geometric
/// mean over the operating points of the depth's standard deviation (root mean square over depth),
/// among unambiguous codes that keep the required margin at every point (the margin of the best
/// standard code, if none keeps it). The search is exhaustive up to symmetry and its result proven
/// if possible; otherwise codes are annealed without proof.
/// @throws InvalidArgument for invalid arguments, or as why_not_searchable()
/// @note results and counts do not depend on the number of threads
/// @see docs/exhaustive_search.md
ChipSearchResult search_chip_codes(const Camera& camera, const ChipSearchOptions& options = {},
                                   const Progress& progress = {});

}  // namespace tofsmith

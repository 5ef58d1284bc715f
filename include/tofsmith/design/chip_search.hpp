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

/// One binary waveform on a chip clock: bit k is set if it is on during chip k.
using ChipWord = std::uint32_t;

/// Largest number of chips of a period.
inline constexpr int max_chips = 24;

/// The word, `shift` chips later on a circle of `chips`. Any shift.
ChipWord delayed_chips(ChipWord word, int shift, int chips);
/// The word reversed in time: chip k becomes chip -k.
ChipWord reversed_chips(ChipWord word, int chips);
/// Every chip.
constexpr ChipWord all_chips(int chips) { return (ChipWord{1} << chips) - 1; }
/// "110" for a word of three chips that is on during the first two.
std::string chip_text(ChipWord word, int chips);
/// The word of such a text. @throws std::invalid_argument for other characters or lengths
ChipWord chip_word(std::string_view text);

/// A code of a camera with a chip clock: every waveform is on or off for whole chips, and at most
/// one tap of an exposure is open at a time.
struct ChipCode {
  int chips = 0;                       ///< n, per period
  int taps = 0;                        ///< t, per exposure
  std::vector<ChipWord> modulation;    ///< (E)
  std::vector<ChipWord> demodulation;  ///< (E x t), exposure by exposure

  int exposures() const { return static_cast<int>(modulation.size()); }
  int measurements() const { return static_cast<int>(demodulation.size()); }
  /// The words of one exposure's taps begin here.
  const ChipWord* taps_of(int exposure) const;
  /// chi of a measurement at a depth of `shift` chips: chips in which light falls on the open tap.
  int correlation(int measurement, int shift) const;
  /// "M 110000 D 110000/001100/000011", exposures parted by ", ".
  std::string text() const;

  /// @throws std::invalid_argument naming the word and the rule it breaks
  void validate() const;

  friend bool operator==(const ChipCode&, const ChipCode&) = default;
};

/// Why a camera has no chip clock: no shortest pulse, or a period that is not a whole number of
/// them, 3 .. max_chips. None: it has one.
std::optional<BrokenRule> why_no_chip_clock(const Camera& camera);

/// Chips per period of a camera's clock: period / sensor.shortest_pulse_s.
/// @throws std::invalid_argument as why_no_chip_clock()
int chips_of(const Camera& camera);

/// Level at which a modulation that is on for `on_chips` plays, over average power: the camera's
/// peak, or what the average allows. With light.peak_factor = 1 it is 1, *peak* power is what is
/// fixed, and S is the rate at peak light; with more, mean power is fixed as soon as peak allows.
double chip_level(int on_chips, int chips, double peak_factor);

/// The code as waveforms, at the camera's levels and samples.
CodeSet to_code_set(const ChipCode& code, const Camera& camera, const std::string& name);

/// How codes on a chip clock are searched.
struct ChipSearchOptions {
  int exposures = 1;  ///< E; with the camera's taps at least 3 measurements, at most 16
  double margin_sigma = 8.0;
  double separation_periods = 1.0 / 36.0;  ///< a quarter chip of nine
  bool equal_duty = true;
  /// A code of three taps of equal duty in one exposure counts 1, another one 20, because it takes
  /// that much longer.
  double max_exhaustive = 3e11;
  int finalists = 4;
  int annealing_starts = 24;
  std::int64_t annealing_steps = 20000;
  std::uint64_t seed = 1;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<ChipSearchOptions> auto& o) {
  return std::tuple(
      Field("exposures", o.exposures, closed(1, 4), FieldMark::from_above, Help{"exposures"}),
      Field("margin_sigma", o.margin_sigma, at_least(0),
            Help{"least distance between depths, in noise"}),
      Field("separation_periods", o.separation_periods, open(0, 0.5),
            Help{"distance from which on depths must keep the margin"}),
      Field("equal_duty", o.equal_duty, Help{"open all taps of an exposure equally long"}),
      Field("max_exhaustive", o.max_exhaustive, at_least(0).or_infinity(),
            Help{"number of codes, after symmetry, up to which all are searched; otherwise codes "
                 "are annealed without proof"}),
      Field("finalists", o.finalists, closed(1, 100), Help{"best codes by the metric to keep"}),
      Field("annealing_starts", o.annealing_starts, closed(0, 10000), ByEffort{2},
            Help{"starts of annealing"}),
      Field("annealing_steps", o.annealing_steps, at_least(1), Help{"steps per start"}),
      Field("seed", o.seed, FieldMark::from_above, Help{"seed of annealing"}));
}

/// What became of all codes. Each was dropped by the first test named that it failed.
struct ChipSearchCounts {
  double raw = 0.0;  ///< codes there are: words of light and taps
  double after_symmetry =
      0.0;                    ///< of these, none a delay, a mirror image or a reordering of another
  std::int64_t examined = 0;  ///< tried one by one, a few symmetric ones twice
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

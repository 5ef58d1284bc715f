// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/design/candidate.hpp"
#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// Why an iterative method ended.
enum class Termination {
  not_run,          ///< nothing was computed; a result starts this way
  converged,        ///< the method's own test of optimality holds
  stalled,          ///< rounding keeps the method from any further progress
  iteration_limit,  ///< the allowed iterations are used up
};

/// The enumerator's name.
std::string_view name_of(Termination termination);

/// How codes are found.
enum class DesignMethod {
  factorize,  ///< waveforms whose correlation functions come close to given ones, as in the paper
  optimize,   ///< all waveforms together, by depth error itself
  search,     ///< all codes on the grid of a chip clock, with proof where that is possible
  best,       ///< all of these that suit the camera
  atlas,      ///< none: codes of the atlas and standard codes are judged, nothing is searched
};
constexpr std::array<std::string_view, 5> words_of(DesignMethod /*any*/) {
  return {"factorize", "optimize", "search", "best", "atlas"};
}
/// The enumerator's name.
std::string_view name_of(DesignMethod method);
/// @throws std::invalid_argument for any other word
DesignMethod parse_design_method(std::string_view name);

/// How the codes of a camera are designed and judged.
struct DesignOptions {
  DesignMethod method = DesignMethod::best;
  /// Each once. Factorization aims at Hamiltonian codes, which have 3 to 6 exposures. On cameras
  /// that read rows of one exposure: numbers of rows.
  std::vector<int> exposures;
  /// A target of the user's, factorized instead of the Hamiltonian ones.
  std::optional<TargetSet> target;
  FactorizeOptions factorize;  ///< its seed comes from the one below
  OptimizeOptions optimize;    ///< so does this one's
  ChipSearchOptions search;    ///< and this one's; its exposures are those above
  /// The gradients see other bandwidths and edge jitter; the choice among all candidates sees all
  /// perturbations (simulate/robustness.hpp).
  bool robust = false;
  /// If absent: suggested_baselines() and, unless only factorization is asked for, all other
  /// built-in codes that few trials find near the best (eight at most).
  std::optional<std::vector<std::string>> baselines;
  /// The best few codes of code_atlas(), fitted to this camera's peak, compete unless only
  /// factorization or search is asked for.
  int atlas_cameras = 4;
  bool best_rotation = true;
  int search_trials = 600;
  int trials = 20000;
  double outlier_threshold_m = default_outlier_threshold_m;
  std::uint64_t seed = 1;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<DesignOptions> auto& o) {
  return std::tuple(
      Field("method", o.method,
            Help{"factorize: factorize correlation functions; optimize: minimize depth error "
                 "itself; search: all codes on a chip clock, with proof; best: all that suit the "
                 "camera, with every baseline as a competitor; atlas: nothing is searched, codes "
                 "of the atlas and standard codes are judged"}),
      Field("exposures", o.exposures, closed(1, 16),
            Help{"numbers of exposures to try (3,4,5), or of rows"},
            IfAbsent{"what suits the camera"}),
      Field("target", o.target, FieldMark::apart),
      Field("factorize", o.factorize, Help{"options of factorization"}),
      Field("optimize", o.optimize, Help{"options of optimization"}),
      Field("search", o.search, Help{"options of the search on a chip clock"}),
      Field("robust", o.robust,
            Help{"optimize for the worst of ±20 % bandwidth, ±10 % peak, 50 ps edge jitter and 2 % "
                 "tap mismatch"}),
      Field("baselines", o.baselines,
            Help{"families that compete, except for those unusable on the camera"},
            IfAbsent{"what suits the method"}),
      Field("atlas_cameras", o.atlas_cameras, closed(0, 1000),
            Help{"how many of the nearest cameras of the atlas lend codes, which compete and are "
                 "where searches start; 0: none"}),
      Field("best_rotation", o.best_rotation,
            Help{"give every candidate its best origin of depth"}),
      Field("search_trials", o.search_trials, at_least(100),
            Help{"trials per operating point while pairs are chosen"}),
      Field("trials", o.trials, closed(1000, 1e8),
            Help{"trials per operating point for final figures"}),
      Field("outlier_threshold_m", o.outlier_threshold_m, at_least(0).or_infinity(),
            outlier_threshold_help),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// The options to search longer, or shorter, by the factor `effort`: 0.1 for a first look, 3 for
/// the last percent; 0 for none at all, DesignMethod::atlas.
/// @throws std::invalid_argument unless effort is 0 or in [0.01, 100], or for 0 and a method other
///         than best or atlas
DesignOptions with_effort(DesignOptions options, double effort);

/// All candidates of a camera, each name once, and which one is best.
struct DesignResult {
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  std::vector<std::string> left_out;  ///< codes and methods the camera cannot use, with the reason
  std::vector<std::string> explanation;  ///< why the winner won, in a few sentences

  const Candidate& winner() const { return candidates[best]; }
  /// The candidate of that name, or null.
  const Candidate* find(std::string_view name) const;
};

/// What candidates are ranked by [m]: the depth error by the camera's choice or, where options ask
/// for robust codes, that on the worst perturbed camera, to which the decoder is calibrated; on
/// cameras with operating.multipath the error in that multipath is weighed in. (Codes that two
/// returns are decoded badly with count as worse, see OptimizeOptions::max_two_return_loss.)
double ranking_error_m(const Candidate& candidate, const Camera& camera,
                       const DesignOptions& options);

/// A code's depth error by the camera's choice, alone: geometric mean over the operating points
/// [m].
double geometric_mean_error_m(const DepthErrorReport& report, DepthErrorKind kind);

/// Called for every code that was to be designed before it is judged, to keep finished work. `load`
/// may return what was designed earlier for the same inputs, which is then used instead of
/// designing again; nothing: design it. Candidates of one name are attempts at one code, of which
/// the judge keeps the best.
struct DesignStore {
  std::function<std::vector<Candidate>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::vector<Candidate>& candidates)> save;
};

/// All candidates, the least geometric_mean_error_m first.
std::vector<const Candidate*> by_geometric_mean_error(const DesignResult& result,
                                                      DepthErrorKind kind);

/// How many times as large another candidate's geometric_mean_error_m is as the winner's, from the
/// same trials; the standard error takes the two for independent, which errs on the large side.
Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorKind kind);

/// Numbers of exposures that suit a method on a camera: fewer the more taps there are, more the
/// wider the band.
std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method);

/// Families that every comparison shows where DesignOptions::baselines names none: for
/// factorization alone the Hamiltonian codes that are aimed at (for a target of the user's, those
/// of the exposures listed), else sinusoids, squares, multi-frequency and Hamiltonian codes.
std::vector<std::string> suggested_baselines(const Camera& camera, const DesignOptions& options);

/// The judge of designs: moves every candidate to its best origin if options ask (best_rotation()),
/// judges all by evaluate() with DesignOptions::seed and trials, random numbers that none was made
/// with, keeps the best of those that share a name, and ranks them by ranking_error_m.
/// Candidates by which no depth can be decoded are left out, with the reason.
/// @param candidates  that the camera can play; their code and how it was made
/// @return the winner is never worse than any candidate given
/// @throws std::invalid_argument for bad options or camera, a code that does not fit, or if nothing
///         is left to judge; Interrupted
DesignResult judge(const Camera& camera, std::vector<Candidate> candidates,
                   const DesignOptions& options = {}, const Progress& progress = {});

/// Designs codes for `camera` by the methods asked for, lets all baselines compete, and lets
/// judge() pick. factorize(), optimize() and search_chip_codes() only make candidates. The naive
/// code of every target (its ideal demodulation with one pulse, where that is known and playable)
/// competes too, so the winner is never worse than naive.
/// @throws std::invalid_argument for bad options, an invalid camera, or targets it cannot play:
///         more than two taps, exposure times for another number of exposures, or a number of
///         samples that cannot represent a Hamiltonian code; Interrupted
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4 and 5
DesignResult design(const Camera& camera, const DesignOptions& options = {},
                    const Progress& progress = {}, const DesignStore& store = {});

/// A camera of the atlas of best codes, in terms that do not depend on its frequency. All else is
/// as in the paper's simulations: 15 MHz, 0.3 s in all, read noise of 20 e, its 5 x 5 light levels.
struct AtlasCamera {
  double peak_factor = 15.0;
  double bandwidth_f0 = 0.0;            ///< f_max of both arms' Hann responses [f0]; 0: no limit
  double shortest_pulse_periods = 0.0;  ///< of the period, pulses and gaps; 0: any
  int taps = 1;
  int exposures = 4;
  DepthErrorKind error = DepthErrorKind::linear;

  /// All of it.
  Camera camera() const;

  friend bool operator==(const AtlasCamera&, const AtlasCamera&) = default;
};

/// The best code that was found for a camera of the atlas.
struct AtlasEntry {
  AtlasCamera of;
  CodeSet code;  ///< "atlas-t1-k4-p15-b10-linear": taps, exposures, peak, bandwidth
  Estimate linear_m, circular_m;  ///< its errors there, geometric means over the light levels
  const Estimate& error_m() const {
    return of.error == DepthErrorKind::linear ? linear_m : circular_m;
  }
};

/// Changes whenever older files are read no more.
inline constexpr int atlas_version = 1;

/// The atlas of best codes that is built in: by taps, exposures, peak, bandwidth and kind of error.
const std::vector<AtlasEntry>& code_atlas();
/// The entry whose code has that name, or null.
const AtlasEntry* find_atlas_entry(std::string_view code);

/// Reads an atlas as scripts/atlas.sh writes it.
/// @param file  what errors call it
/// @throws IoError "file:line: .." for one of another version, and for what is damaged
std::vector<AtlasEntry> parse_atlas(std::string_view text, std::string_view file = "atlas.txt");

/// Of entries that differ in their exposures alone, those with the least error.
std::vector<AtlasEntry> best_by_exposures(const std::vector<AtlasEntry>& entries);

/// A power law through errors of the atlas: error = at_ones_m bandwidth^-a peak^-b.
struct AtlasLaw {
  double at_ones_m = 0.0;
  double bandwidth_power = 0.0, peak_power = 0.0;  ///< a and b
  double rms_residual = 0.0, max_residual = 0.0;   ///< of log error
  int entries = 0;                                 ///< that it was fitted to
  /// What it says of a camera with a bandwidth [m].
  double error_m(const AtlasCamera& camera) const;
};

/// Fits a law to those of the entries that have a bandwidth; none: they are fewer than 6, or all of
/// one bandwidth or peak.
std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries);

/// What a requirement can vary of a camera.
enum class CameraQuantity {
  bandwidth,  ///< of both arms: their cutoffs; shorter pulses with it
  power,      ///< of the modulated light
  exposure,   ///< integration time
};
/// The enumerator's name.
std::string_view name_of(CameraQuantity quantity);
/// @throws std::invalid_argument for any other word
CameraQuantity parse_camera_quantity(std::string_view name);

/// The camera with `factor` times as much of a quantity, > 0.
/// @throws InvalidArgument for bandwidth, where neither arm has a limit
Camera with_scaled(Camera camera, CameraQuantity quantity, double factor);

/// How a requirement is met.
struct RequirementOptions {
  double error_m = 0.005;
  bool vary_bandwidth = true;
  bool vary_power = true;
  bool vary_exposure = true;
  double max_factor = 64.0;
  double effort = 0.1;  ///< see with_effort()
  int trials = 50000;
  bool map = true;
  std::uint64_t seed = 1;

  /// What is varied, in the order of the enumeration.
  std::vector<CameraQuantity> varied() const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<RequirementOptions> auto& o) {
  return std::tuple(
      Field(
          "error_m", o.error_m, above(0),
          Help{"circular depth error that is asked for: geometric mean over the operating points"}),
      Field("vary_bandwidth", o.vary_bandwidth, Help{"vary the bandwidth of both arms"}),
      Field("vary_power", o.vary_power, Help{"vary the power of the modulated light"}),
      Field("vary_exposure", o.vary_exposure, Help{"vary the integration time"}),
      Field("max_factor", o.max_factor, left_open(1, 1e6),
            Help{"largest factor by which a quantity is increased or decreased"}),
      Field("effort", o.effort, closed(0.01, 100), Help{"effort of the search for each code"}),
      Field("trials", o.trials, closed(1000, 1e8), Help{"trials per operating point"}),
      Field("map", o.map, Help{"compute the error over bandwidth and power, if both are varied"}),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// How much of one quantity it takes, everything else as the camera has it.
struct Sufficiency {
  CameraQuantity quantity = CameraQuantity::power;
  /// Times the camera's: the least that suffices; none: not even max_factor does.
  std::optional<double> factor;
  double error_m = 0.0;  ///< there, or at max_factor
  CodeSet code;          ///< that reaches it
  /// Below this factor no code can, by ReceiverBound; 0: the bound excludes nothing.
  double excluded_below = 0.0;
};

/// Error of the best code found at each bandwidth, over power, by a tenth of the trials.
struct RequirementMap {
  std::vector<double> bandwidth, power;  ///< factors, ascending
  Eigen::MatrixXd error_m;               ///< (bandwidth, power)
};

/// What it takes of a camera to measure depth as well as asked.
struct Requirements {
  double error_m = 0.0;             ///< that the camera reaches as it is
  CodeSet code;                     ///< with this code
  double bound_m = 0.0;             ///< ReceiverBound of the camera as it is; 0: none
  std::vector<Sufficiency> varied;  ///< in the order of the enumeration
  std::optional<RequirementMap> map;
};

/// Finds, for each quantity by itself, the least with which a code reaches the error: codes are
/// designed at every factor of four on the way and again where the search ends, and every code
/// found is judged with the baselines, by the same random numbers. The error falls with each
/// quantity, so the least is found by halving; to 0.5 %. The circular error counts, whatever the
/// camera says: at a given distance nothing wraps.
/// @throws std::invalid_argument as design(), for bad options, or for bandwidth where there is no
///         limit; Interrupted
Requirements find_requirements(const Camera& camera, const RequirementOptions& options,
                               const Progress& progress = {});

}  // namespace tofsmith

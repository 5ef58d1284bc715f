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

/// Reason why an iterative method ended.
enum class Termination {
  not_run,          ///< initial state of a result
  converged,        ///< the optimality test of the method is met
  stalled,          ///< rounding prevents further progress
  iteration_limit,  ///< maximum number of iterations reached
};

/// Returns the name of the enumerator.
std::string_view name_of(Termination termination);

/// Method of finding codes.
enum class DesignMethod {
  factorize,    ///< waveforms whose correlation functions approximate given ones, as in the paper
  optimize,     ///< all waveforms jointly, by minimizing the depth error
  search,       ///< exhaustive search on the grid of a chip clock, proven optimal if possible
  best,         ///< all methods that the camera supports
  atlas,        ///< no search: codes from the atlas and standard codes are ranked
  frequencies,  ///< square waves at frequencies that the chip can generate
};
constexpr std::array<std::string_view, 6> words_of(DesignMethod /*any*/) {
  return {"factorize", "optimize", "search", "best", "atlas", "frequencies"};
}
/// Returns the name of the enumerator.
std::string_view name_of(DesignMethod method);
/// @throws std::invalid_argument for unknown names
DesignMethod parse_design_method(std::string_view name);

/// Options for designing and ranking codes for a camera.
struct DesignOptions {
  DesignMethod method = DesignMethod::best;
  /// Distinct numbers of exposures, or of rows for cameras that read rows of one exposure.
  /// Factorization approximates Hamiltonian codes with 3 to 6 exposures.
  std::vector<int> exposures;
  /// Replaces the Hamiltonian targets of the factorization.
  std::optional<TargetSet> target;
  FactorizeOptions factorize;  ///< its seed is replaced by `seed`
  OptimizeOptions optimize;    ///< its seed is replaced by `seed`
  ChipSearchOptions search;    ///< its seed and exposures are replaced by `seed` and `exposures`
  /// If true, gradients include other bandwidths and edge jitter, and candidates are ranked by
  /// their error on the worst perturbed camera (simulate/robustness.hpp).
  bool robust = false;
  /// If absent: suggested_baselines() and, unless the method is factorize, up to eight other
  /// built-in codes from a quick screening.
  std::optional<std::vector<std::string>> baselines;
  /// Number of most similar cameras in code_atlas() whose codes compete. Their codes are also tried
  /// with pulses adapted to the peak of this camera. Not used by factorize and search.
  int atlas_cameras = 4;
  bool best_rotation = true;
  /// If true, optimized and factorized codes are also tried with exposures of different length.
  bool split_exposures = false;
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
            Help{"best: try all applicable methods and rank them with the standard codes; "
                 "optimize: minimize depth error; factorize: approximate correlation functions; "
                 "search: exhaustive, on a chip clock; atlas: no search, rank known codes only; "
                 "frequencies: square waves at frequencies of the chip"}),
      Field("exposures", o.exposures, closed(1, 16),
            Help{"numbers of exposures or rows to try, such as 3,4,5"},
            IfAbsent{"suitable numbers for the camera"}),
      Field("target", o.target, FieldMark::apart),
      Field("factorize", o.factorize, Help{"options of factorization"}),
      Field("optimize", o.optimize, Help{"options of optimization"}),
      Field("search", o.search, Help{"options of the search on a chip clock"}),
      Field("robust", o.robust,
            Help{"optimize for the worst of ±20 % bandwidth, ±10 % peak, 50 ps edge jitter and 2 % "
                 "tap mismatch"}),
      Field("baselines", o.baselines,
            Help{"standard codes to compare with; unsupported ones are skipped"},
            IfAbsent{"suitable codes for the method"}),
      Field("atlas_cameras", o.atlas_cameras, closed(0, 1000),
            Help{"number of most similar atlas cameras whose codes compete and start searches; 0: "
                 "none"}),
      Field("best_rotation", o.best_rotation,
            Help{"choose the best origin of depth for every candidate"}),
      Field("split_exposures", o.split_exposures,
            Help{"also try exposures of different length for optimized and factorized codes"}),
      Field("search_trials", o.search_trials, at_least(100),
            Help{"trials per operating point while factorized waveforms or rows are selected"}),
      Field("trials", o.trials, closed(1000, 1e8),
            Help{"trials per operating point of the final evaluation"}),
      Field("outlier_threshold_m", o.outlier_threshold_m, at_least(0).or_infinity(),
            outlier_threshold_help),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// Scales the work of all searches: 0.1 for a quick look, 3 for the last percent, 0 for no search
/// (DesignMethod::atlas).
/// @throws std::invalid_argument unless effort is in [0.01, 100], or 0 with method best or atlas
DesignOptions with_effort(DesignOptions options, double effort);

/// Candidates with distinct names, and the index of the best one.
struct DesignResult {
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  std::vector<std::string> left_out;     ///< unusable codes and methods with reasons
  std::vector<std::string> explanation;  ///< why the winner is best

  const Candidate& winner() const { return candidates[best]; }
  /// Returns the candidate with this name, or null.
  const Candidate* find(std::string_view name) const;
};

/// Returns the error by which candidates are ranked [m]: of the kind and statistic selected by the
/// camera. With DesignOptions::robust, it is the error on the worst perturbed camera with a
/// calibrated decoder. On cameras with operating.multipath it includes the error in that multipath
/// and a penalty for large two-return errors (OptimizeOptions::max_two_return_loss).
double ranking_error_m(const Candidate& candidate, const Camera& camera,
                       const DesignOptions& options);

/// Returns the geometric mean over the operating points [m].
double geometric_mean_error_m(const DepthErrorReport& report, DepthErrorMeasure measure);

/// Callbacks for finished designs. `load` returns candidates saved earlier under `name` for the
/// same inputs; if none, the code is designed and passed to `save`. Candidates of one name are
/// alternatives, of which judge() keeps the best.
struct DesignStore {
  std::function<std::vector<Candidate>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::vector<Candidate>& candidates)> save;
};

/// Returns all candidates by ascending geometric_mean_error_m().
std::vector<const Candidate*> by_geometric_mean_error(const DesignResult& result,
                                                      DepthErrorMeasure measure);

/// Returns the ratio of another candidate's geometric_mean_error_m() to the winner's, from the same
/// trials. The standard error ignores their correlation, so it is an overestimate.
Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorMeasure measure);

/// Returns suitable numbers of exposures: fewer with more taps, more with larger bandwidth.
std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method);

/// Returns the default of DesignOptions::baselines. For factorization, these are the Hamiltonian
/// codes that serve as targets, or with a custom target, the Hamiltonian codes with the listed
/// numbers of exposures. Otherwise they are sinusoids, squares, multi-frequency and Hamiltonian
/// codes.
std::vector<std::string> suggested_baselines(const Camera& camera, const DesignOptions& options);

/// Ranks candidates by ranking_error_m(): evaluates all, at their best origins if requested
/// (best_rotation()), with new random numbers (DesignOptions::seed and trials), and keeps the best
/// of each name. Candidates without decodable depth are listed in DesignResult::left_out.
/// @param candidates  codes that the camera supports, with the method that found each
/// @return the best candidate of each name. The winner is never worse than any given candidate with
///   one of the numbers in DesignOptions::exposures. If there is no such candidate, or the list is
///   empty, it is never worse than any given candidate.
/// @throws std::invalid_argument for invalid options or camera, an unsupported code, or no usable
///   candidate; Interrupted
DesignResult judge(const Camera& camera, std::vector<Candidate> candidates,
                   const DesignOptions& options = {}, const Progress& progress = {});

/// Designs codes by the requested methods and ranks them with all baselines by judge(). The naive
/// code of each target (its ideal demodulation with one pulse, if known and supported) competes,
/// too, so the winner is never worse.
/// @throws std::invalid_argument for invalid options or camera, or unsupported targets: more than
///   two taps, exposure times for another number of exposures, or a number of samples that cannot
///   represent a Hamiltonian code; Interrupted
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4 and 5
DesignResult design(const Camera& camera, const DesignOptions& options = {},
                    const Progress& progress = {}, const DesignStore& store = {});

/// Camera of the atlas of best codes. Bandwidth and pulses are relative to the frequency. All other
/// properties are as in the paper's simulations: 15 MHz, 0.3 s in total, read noise of 20 e, 5 x 5
/// light levels.
struct AtlasCamera {
  double peak_factor = 15.0;
  double bandwidth_f0 = 0.0;            ///< f_max of both arms' Hann responses [f0]; 0: no limit
  double shortest_pulse_periods = 0.0;  ///< pulses and gaps / period; 0: no limit
  int taps = 1;
  int exposures = 4;
  DepthErrorKind error = DepthErrorKind::linear;

  Camera camera() const;

  friend bool operator==(const AtlasCamera&, const AtlasCamera&) = default;
};

/// The best known code for a camera of the atlas.
struct AtlasEntry {
  AtlasCamera of;
  CodeSet code;  ///< "atlas-t1-k4-p15-b10-linear": taps, exposures, peak, bandwidth
  Estimate linear_m, circular_m;  ///< on that camera, geometric means over the light levels
  const Estimate& error_m() const {
    return of.error == DepthErrorKind::linear ? linear_m : circular_m;
  }
};

/// Incremented on incompatible changes of the file format.
inline constexpr int atlas_version = 1;

/// Returns the built-in atlas, sorted by taps, exposures, peak, bandwidth and kind of error.
const std::vector<AtlasEntry>& code_atlas();
/// Returns the entry with this code name, or null.
const AtlasEntry* find_atlas_entry(std::string_view code);

/// Parses an atlas file written by scripts/atlas.sh.
/// @param file  file name for error messages
/// @throws IoError "file:line: ..." if the version is not supported or the file is damaged
std::vector<AtlasEntry> parse_atlas(std::string_view text, std::string_view file = "atlas.txt");

/// Returns the entries with the best number of exposures, all else being equal.
std::vector<AtlasEntry> best_by_exposures(const std::vector<AtlasEntry>& entries);

/// A power law of atlas errors: error = at_ones_m bandwidth^-a peak^-b.
struct AtlasLaw {
  double at_ones_m = 0.0;
  double bandwidth_power = 0.0, peak_power = 0.0;  ///< a and b
  double rms_residual = 0.0, max_residual = 0.0;   ///< of log error
  int entries = 0;                                 ///< that were fitted
  /// Returns the predicted error of a camera with limited bandwidth [m].
  double error_m(const AtlasCamera& camera) const;
};

/// Fits the entries with limited bandwidth. Returns none if there are fewer than 6 such entries, or
/// if all have the same bandwidth or the same peak.
std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries);

/// Quantity that find_requirements() can vary.
enum class CameraQuantity {
  bandwidth,  ///< of both arms: cutoffs and shortest pulse
  power,      ///< of the modulated light
  exposure,   ///< integration time
};
/// Returns the name of the enumerator.
std::string_view name_of(CameraQuantity quantity);
/// @throws std::invalid_argument for unknown names
CameraQuantity parse_camera_quantity(std::string_view name);

/// Returns the camera with a quantity scaled by `factor`, > 0.
/// @throws InvalidArgument for bandwidth without a band limit
Camera with_scaled(Camera camera, CameraQuantity quantity, double factor);

/// Options of find_requirements().
struct RequirementOptions {
  double error_m = 0.005;
  bool vary_bandwidth = true;
  bool vary_power = true;
  bool vary_exposure = true;
  double max_factor = 64.0;
  bool exact = false;
  double effort = 0.1;  ///< see with_effort(); only if exact
  int trials = 50000;
  bool map = true;
  std::uint64_t seed = 1;

  /// Returns the varied quantities in the order of the enumeration.
  std::vector<CameraQuantity> varied() const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<RequirementOptions> auto& o) {
  return std::tuple(
      Field("error_m", o.error_m, above(0),
            Help{"required circular depth error: geometric mean over the operating points"}),
      Field("vary_bandwidth", o.vary_bandwidth, Help{"vary the bandwidth of both arms"}),
      Field("vary_power", o.vary_power, Help{"vary the power of the modulated light"}),
      Field("vary_exposure", o.vary_exposure, Help{"vary the integration time"}),
      Field("max_factor", o.max_factor, left_open(1, 1e6),
            Help{"largest factor by which a quantity is increased or decreased"}),
      Field(
          "exact", o.exact,
          Help{"design codes (minutes) instead of taking them from the atlas (seconds); the result "
               "can be smaller"}),
      Field("effort", o.effort, closed(0.01, 100), Help{"effort of the search for each code"},
            OnlyWith{"exact"}),
      Field("trials", o.trials, closed(1000, 1e8), Help{"trials per operating point"}),
      Field("map", o.map, Help{"compute the error over bandwidth and power, if both are varied"}),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// Required amount of one quantity, all others being equal.
struct Sufficiency {
  CameraQuantity quantity = CameraQuantity::power;
  /// Smallest sufficient factor; none: max_factor is insufficient.
  std::optional<double> factor;
  double error_m = 0.0;  ///< at that factor, or at max_factor
  CodeSet code;          ///< with this error
  /// No code is sufficient below this factor, by ReceiverBound; 0: no such factor.
  double excluded_below = 0.0;
};

/// Error of the best code at each bandwidth and power, estimated with few trials.
struct RequirementMap {
  std::vector<double> bandwidth, power;  ///< factors, ascending
  Eigen::MatrixXd error_m;               ///< (bandwidth, power)
};

/// Result of find_requirements().
struct Requirements {
  double error_m = 0.0;             ///< of the unmodified camera
  CodeSet code;                     ///< with this error
  double bound_m = 0.0;             ///< ReceiverBound; 0: none
  std::vector<Sufficiency> varied;  ///< in the order of the enumeration
  std::optional<RequirementMap> map;
};

/// Finds the smallest amount of each quantity, varied separately, for which a code has at most the
/// requested error. Codes are taken from the atlas or, if `exact`, designed. This is done at steps
/// of a factor of 4, and again at the factor that the search finds. These codes and the standard
/// codes are evaluated with the same random numbers. The codes found reach the error; a designed
/// code may need less. Bisection finds the factor to 0.5 %, because the error decreases with each
/// quantity. The error is always circular, because a surface at a given distance causes no
/// wrap-around.
/// @throws std::invalid_argument as design(), for invalid options, or for bandwidth without a band
///   limit; Interrupted
Requirements find_requirements(const Camera& camera, const RequirementOptions& options,
                               const Progress& progress = {});

}  // namespace tofsmith

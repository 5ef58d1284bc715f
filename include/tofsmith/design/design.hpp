// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  not_run,    ///< initial state
  converged,  ///< the optimality test is met
  stalled,    ///< rounding prevents further progress
  iteration_limit,
};
constexpr auto words_of(Termination /*any*/) {
  return word_list("not_run", "converged", "stalled", "iteration_limit");
}

enum class DesignMethod {
  factorize,    ///< approximate given correlation functions, as in the paper
  optimize,     ///< minimize the depth error over all waveforms
  search,       ///< exhaustive on the grid of a chip clock, proven optimal if possible
  best,         ///< all that the camera supports
  atlas,        ///< rank known codes only
  frequencies,  ///< square waves at frequencies of the chip
};
constexpr auto words_of(DesignMethod /*any*/) {
  return word_list("factorize", "optimize", "search", "best", "atlas", "frequencies");
}

struct DesignOptions {
  DesignMethod method = DesignMethod::best;
  /// Distinct numbers of exposures, or of rows of one exposure. Factorization approximates
  /// Hamiltonian codes with 3 to 6 exposures.
  std::vector<int> exposures;
  /// Replaces the Hamiltonian targets of the factorization.
  std::optional<TargetSet> target;
  FactorizeOptions factorize;  ///< its seed is ignored
  OptimizeOptions optimize;    ///< its seed is ignored
  ChipSearchOptions search;    ///< its seed and exposures are ignored
  /// Includes other bandwidths and edge jitter in gradients, and ranks candidates by their error on
  /// the worst perturbed camera (simulate/robustness.hpp).
  bool robust = false;
  /// Absent: suggested_baselines() and, unless the method is factorize, up to eight other built-in
  /// codes from a quick screening.
  std::optional<std::vector<std::string>> baselines;
  /// Codes of these cameras are also tried with pulses adapted to the peak of this one. Not used by
  /// factorize and search.
  int atlas_cameras = 4;
  bool best_rotation = true;
  bool split_exposures = false;
  int search_trials = 600;
  int trials = 20000;
  double outlier_threshold_m = default_outlier_threshold_m;
  std::uint64_t seed = 1;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<DesignOptions> auto& o) {
  return std::tuple(
      Field("method", o.method,
            Help{"best: try all applicable methods and rank their codes together with the "
                 "standard codes; optimize: minimize the depth error; factorize: approximate "
                 "target correlation functions; search: exhaustive search for codes that switch "
                 "on a clock grid; atlas: only rank atlas codes and standard codes; "
                 "frequencies: square waves at frequencies that the camera supports"}),
      Field("exposures", o.exposures, closed(1, 16),
            Help{"numbers of exposures to try, such as 3,4,5; numbers of rows if the camera has "
                 "sensor.readout = rows"},
            IfAbsent{"suitable numbers for the camera"}),
      Field("target", o.target, FieldMark::apart),
      Field("factorize", o.factorize, Help{"options of factorization"}),
      Field("optimize", o.optimize, Help{"options of optimization"}),
      Field("search", o.search, Help{"options of the search on a chip clock"}),
      Field("robust", o.robust,
            Help{"optimize for the worst case of ±20 % bandwidth, ±10 % peak power, 50 ps edge "
                 "jitter and 2 % tap mismatch"}),
      Field("baselines", o.baselines,
            Help{"standard codes to compare with; unsupported ones are skipped"},
            IfAbsent{"suitable codes for the method"}),
      Field("atlas_cameras", o.atlas_cameras, closed(0, 1000),
            Help{"number of atlas cameras whose codes are ranked as well and are starting points "
                 "of searches; the most similar cameras are used; 0: none"}),
      Field("best_rotation", o.best_rotation,
            Help{"choose the best origin of depth for every candidate"}),
      Field("split_exposures", o.split_exposures,
            Help{"also try exposures of different length for optimized and factorized codes"}),
      Field("search_trials", o.search_trials, at_least(100),
            Help{"trials per operating point while factorized waveforms or rows are selected"}),
      Field("trials", o.trials, closed(1000, 1e8),
            Help{"trials per operating point of the final evaluation; codes that it cannot "
                 "distinguish from the best are evaluated again with up to 12 times as many"}),
      Field("outlier_threshold_m", o.outlier_threshold_m, at_least(0).or_infinity(),
            outlier_threshold_help),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// Scales the work of all searches: 0.1 for a quick look, 0 for none (DesignMethod::atlas).
/// @throws InvalidArgument unless effort is in [0.01, 100], or 0 with method best or atlas
DesignOptions with_effort(DesignOptions options, double effort);

/// Candidates have distinct names.
struct DesignResult {
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  std::vector<std::string> left_out;     ///< unusable codes and methods with reasons
  std::vector<std::string> explanation;  ///< why the winner is best

  const Candidate& winner() const { return candidates[best]; }
  /// Null if there is none.
  const Candidate* find(std::string_view name) const;
};

/// Returns the error by which candidates are ranked [m], of the camera's kind and statistic; with
/// DesignOptions::robust, on the worst perturbed camera. It includes the error in
/// operating.multipath, if any, with a penalty for large two-return errors.
double ranking_error_m(const Candidate& candidate, const Camera& camera,
                       const DesignOptions& options);

/// Geometric mean over the operating points.
double geometric_mean_error_m(const DepthErrorReport& report, DepthErrorMeasure measure);

/// Callbacks for finished designs. `load` returns candidates saved earlier under `name` for the
/// same inputs; if none, the code is designed and passed to `save`. judge() keeps the best of each
/// name.
struct DesignStore {
  std::function<std::vector<Candidate>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::vector<Candidate>& candidates)> save;
};

/// Candidates by ascending geometric_mean_error_m().
std::vector<const Candidate*> by_geometric_mean_error(const DesignResult& result,
                                                      DepthErrorMeasure measure);

/// Ratio of another candidate's geometric_mean_error_m() to the winner's. The standard error
/// ignores the correlation of common trials and is an overestimate.
Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorMeasure measure);

/// Returns fewer exposures with more taps, and more with larger bandwidth.
std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method);

/// Default of DesignOptions::baselines: Hamiltonian codes, and unless the method is factorize,
/// sinusoids, squares and multi-frequency codes.
std::vector<std::string> suggested_baselines(const Camera& camera, const DesignOptions& options);

/// Ranks candidates by ranking_error_m() with new random numbers, at their best origins if
/// requested. With operating.velocity_m_per_s, the exposures are first put into the order with the
/// smallest MotionBias. Lists candidates without decodable depth in DesignResult::left_out.
/// @param candidates  codes that the camera supports
/// @return the best candidate of each name. The winner is never worse than any given candidate with
///   one of the numbers in DesignOptions::exposures, or than any candidate if none has such a
///   number.
/// @throws InvalidArgument for invalid options or camera, an unsupported code, or no usable
///          candidate
DesignResult judge(const Camera& camera, std::vector<Candidate> candidates,
                   const DesignOptions& options = {}, const Progress& progress = {});

/// Designs codes by the requested methods and ranks them with all baselines by judge(). The ideal
/// demodulation of each target with one pulse competes, too.
/// @throws InvalidArgument for invalid options or camera, or unsupported targets: more than two
///   taps, exposure times for another number of exposures, or a number of samples that cannot
///   represent a Hamiltonian code
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4 and 5
DesignResult design(const Camera& camera, const DesignOptions& options = {},
                    const Progress& progress = {}, const DesignStore& store = {});

/// Camera of the atlas of best codes. All other properties are as in the paper's simulations: 15
/// MHz, 0.3 s in total, read noise of 20 e, 5 x 5 light levels.
struct AtlasCamera {
  double peak_factor = 15.0;
  double bandwidth_f0 = 0.0;            ///< f_max of both arms' Hann responses / f0; 0: no limit
  double shortest_pulse_periods = 0.0;  ///< pulses and gaps / period; 0: no limit
  int taps = 1;
  int exposures = 4;
  DepthErrorKind error = DepthErrorKind::linear;

  Camera camera() const;

  friend bool operator==(const AtlasCamera&, const AtlasCamera&) = default;
};

/// Best known code for a camera of the atlas.
struct AtlasEntry {
  AtlasCamera of;
  /// Named "atlas-4x1-peak15-hann10-linear": exposures x taps, peak factor, bandwidth over f0, kind
  /// of error. Without bandwidth limit, "pulse0.0075" is the shortest pulse in periods.
  CodeSet code;
  Estimate linear_m, circular_m;  ///< on that camera, geometric means over the light levels
  const Estimate& error_m() const {
    return of.error == DepthErrorKind::linear ? linear_m : circular_m;
  }
};

/// Incremented on incompatible changes of the file format.
inline constexpr int atlas_version = 1;

/// The atlas, sorted by taps, exposures, peak, bandwidth and kind of error.
const std::vector<AtlasEntry>& code_atlas();
/// Returns the entry with this code name, or with its former name "atlas-t1-k4-p15-b10-linear";
/// null for other names.
const AtlasEntry* find_atlas_entry(std::string_view code);

/// Parses an atlas file of scripts/atlas.sh.
/// @throws IoError if the version is not supported or the file is damaged
std::vector<AtlasEntry> parse_atlas(std::string_view text, std::string_view file = "atlas.txt");

/// Entries with the best number of exposures, all else being equal.
std::vector<AtlasEntry> best_by_exposures(const std::vector<AtlasEntry>& entries);

/// Power law of atlas errors: error = at_ones_m bandwidth^-a peak^-b.
struct AtlasLaw {
  double at_ones_m = 0.0;
  double bandwidth_power = 0.0, peak_power = 0.0;  ///< a and b
  double rms_residual = 0.0, max_residual = 0.0;   ///< of log error
  int entries = 0;                                 ///< fitted
};

/// Fits the entries with limited bandwidth; none if there are fewer than 6, or all have the same
/// bandwidth or the same peak.
std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries);

/// Quantity that find_requirements() can vary.
enum class CameraQuantity {
  bandwidth,  ///< of both arms: cutoffs and shortest pulse
  power,      ///< of the modulated light
  exposure,   ///< integration time
};
constexpr auto words_of(CameraQuantity /*any*/) {
  return word_list("bandwidth", "power", "exposure");
}

/// Returns the camera with a quantity scaled by `factor` > 0.
/// @throws InvalidArgument for bandwidth without a band limit
Camera with_scaled(Camera camera, CameraQuantity quantity, double factor);

struct RequirementOptions {
  double error_m = 0.005;
  bool vary_bandwidth = true;
  bool vary_power = true;
  bool vary_exposure = true;
  double max_factor = 64.0;
  bool exact = false;
  double effort = 0.1;  ///< see with_effort()
  int trials = 50000;
  bool map = true;
  std::uint64_t seed = 1;

  /// In the order of the enumeration.
  std::vector<CameraQuantity> varied() const;

  /// @throws InvalidArgument
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
      Field("exact", o.exact,
            Help{"design a code for each tried bandwidth, power or exposure (minutes) instead of "
                 "using atlas codes (seconds); the required value can be smaller with designed "
                 "codes"}),
      Field("effort", o.effort, closed(0.01, 100),
            Help{"search effort for each code, relative to the default effort of a design"},
            OnlyWith{"exact"}),
      Field("trials", o.trials, closed(1000, 1e8), Help{"trials per operating point"}),
      Field("map", o.map,
            Help{"compute a map of the error over bandwidth and power, if both are varied"}),
      Field("seed", o.seed, Help{"seed of every random choice"}));
}

/// Required amount of one quantity, all others being equal.
struct Sufficiency {
  CameraQuantity quantity = CameraQuantity::power;
  /// Smallest sufficient factor; absent if max_factor is insufficient.
  std::optional<double> factor;
  double error_m = 0.0;  ///< at that factor, or at max_factor
  CodeSet code;          ///< with this error
  /// No code is sufficient below this factor, by ReceiverBound; 0: no such factor.
  double excluded_below = 0.0;
};

/// Error of the best code at each bandwidth and power, with few trials.
struct RequirementMap {
  std::vector<double> bandwidth, power;  ///< factors, ascending
  Eigen::MatrixXd error_m;               ///< (bandwidth, power)
};

struct Requirements {
  double error_m = 0.0;             ///< of the unmodified camera
  CodeSet code;                     ///< with this error
  double bound_m = 0.0;             ///< ReceiverBound; 0: none
  std::vector<Sufficiency> varied;  ///< in the order of the enumeration
  std::optional<RequirementMap> map;
};

/// Finds the smallest amount of each quantity, varied separately, for which a code has at most the
/// requested circular error. Codes are standard codes, and atlas codes or, if `exact`, designed
/// ones; a designed code may need less. Bisection finds the factor to 0.5 %, because the error
/// decreases with each quantity.
/// @throws InvalidArgument as design(), for invalid options, or for bandwidth without a band limit
Requirements find_requirements(const Camera& camera, const RequirementOptions& options,
                               const Progress& progress = {});

}  // namespace tofsmith

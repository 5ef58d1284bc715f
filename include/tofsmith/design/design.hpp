// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/design/optimize.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// How codes are found.
enum class DesignMethod {
  factorize,  ///< waveforms whose correlation functions come close to given ones, as in the paper
  optimize,   ///< all waveforms together, by depth error itself
  search,     ///< all codes on the grid of a chip clock, with proof where that is possible
  best,       ///< all of these that suit the camera
};
/// The enumerator's name.
std::string_view name_of(DesignMethod method);

/// How the codes of a camera are designed and judged.
struct DesignOptions {
  DesignMethod method = DesignMethod::best;
  /// Numbers of exposures to design for, 1 .. 8, each once; none: what suits method and camera
  /// (suggested_exposures). Factorization aims at Hamiltonian codes, which have 3 .. 6.
  std::vector<int> exposures;
  /// A target of the user's, factorized instead of the Hamiltonian ones.
  std::optional<TargetSet> target;
  FactorizeOptions factorize;
  OptimizeOptions optimize;  ///< its seed comes from the one below
  ChipSearchOptions search;  ///< so does this one's; its exposures are those above
  /// Optimize for, and pick by, the error on the worst of the camera's perturbations
  /// (simulate/robustness.hpp) instead of the camera's own. The gradients see other bandwidths and
  /// edge jitter; the choice among all candidates sees all perturbations.
  bool robust = false;
  /// Families that compete, whether or not anything is designed; those the camera cannot play are
  /// left out.
  std::vector<std::string> baselines = {
      "sinusoid-k3",    "sinusoid-k4",    "square-k4",      "multifrequency-k5",
      "hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "pulsed-multifrequency-k5"};
  bool best_rotation = true;  ///< for the linear error: give every candidate its best origin
  int search_trials = 600;    ///< per operating point, while pairs are chosen; >= 100
  int trials = 20000;         ///< per operating point, for the final figures; >= 1000
  std::uint64_t seed = 1;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DesignOptions> auto& o) {
  return std::tuple(Field("method", o.method), Field("exposures", o.exposures, "in [1, 8]"),
                    Field("target", o.target, Mark::apart), Field("factorize", o.factorize),
                    Field("optimize", o.optimize), Field("search", o.search),
                    Field("robust", o.robust), Field("baselines", o.baselines),
                    Field("best_rotation", o.best_rotation),
                    Field("search_trials", o.search_trials, ">= 100"),
                    Field("trials", o.trials, ">= 1000"), Field("seed", o.seed));
}

/// The options to search longer, or shorter, by the factor `effort`: 0.1 for a first look, 3 for
/// the last percent.
/// @throws std::invalid_argument unless effort is in [0.01, 100]
DesignOptions with_effort(DesignOptions options, double effort);

/// One measurement of a designed code and, if it has one, how it compares with its target.
struct MeasurementReport {
  double residual_rms = 0.0;           ///< of the pair chosen by depth error; 0 without a target
  double smallest_residual_rms = 0.0;  ///< of the pair that comes closest to the target
  double demodulation_duty = 0.0;
  double modulation_duty = 0.0;
  double peak = 0.0;
  int edges = 0;                            ///< of modulation and demodulation together
  std::string start;                        ///< which start of the pool it came from
  std::vector<FactorizeIteration> history;  ///< as Factorization::history
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<MeasurementReport> auto& m) {
  return std::tuple(
      Field("residual_rms", m.residual_rms, "finite and >= 0", Mark::may_be_null),
      Field("smallest_residual_rms", m.smallest_residual_rms, "finite and >= 0", Mark::may_be_null),
      Field("demodulation_duty", m.demodulation_duty), Field("modulation_duty", m.modulation_duty),
      Field("peak", m.peak), Field("edges", m.edges, ">= 0"), Field("start", m.start),
      Field("history", m.history, Mark::apart));
}

/// How far a search had come after some work.
struct SearchStep {
  double work = 0.0;     ///< in the units of SearchRecord
  double error_m = 0.0;  ///< smallest error until then, as the search measures it
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<SearchStep> auto& s) {
  return std::tuple(Field("work", s.work), Field("error_m", s.error_m));
}

/// How a code was searched for.
struct SearchRecord {
  std::string work_unit;   ///< "gradient steps" or "candidates"
  std::string error_name;  ///< what the steps' error is
  std::vector<SearchStep> steps;
  bool proved = false;  ///< no other code of the searched kind is better
  std::string account;  ///< what was searched, counted and ruled out by which test
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<SearchRecord> auto& s) {
  return std::tuple(Field("work_unit", s.work_unit), Field("error_name", s.error_name),
                    Field("steps", s.steps), Field("proved", s.proved),
                    Field("account", s.account));
}

/// A code that competes for the camera.
struct Candidate {
  CodeSet code;
  std::string method;      ///< "family", "naive", "reference", "factorize", "optimize" or "search"
  DepthErrorReport error;  ///< what evaluate() says of the code with the design's seed and trials
  int rotation_bin = 0;    ///< how far the origin was moved
  int iterations = 0;      ///< convex or gradient steps over all starts that led to it
  double seconds = 0.0;    ///< time it took to design
  Eigen::MatrixXd target;  ///< what it was factorized for (N, K); else empty
  std::vector<MeasurementReport> per_measurement;  ///< of designed codes; one per demodulation
  std::optional<SearchRecord> search;              ///< of optimized and searched codes
  std::string message;                             ///< one line on how it came out
  /// The error when the camera is not quite what it was said to be; of the winner, and with
  /// DesignOptions::robust of all.
  std::optional<RobustnessReport> robustness;

  /// Error behind second returns; on cameras with operating.multipath.
  std::optional<SecondReturnReport> second_returns;

  /// Made for this camera, by any method; not a family, a reference or a naive code.
  bool is_designed() const { return !per_measurement.empty(); }
};

/// All candidates of a camera and which one is best by the camera's chosen depth error.
struct DesignResult {
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  std::vector<std::string> left_out;  ///< codes and methods the camera cannot use, with the reason
  std::vector<std::string> explanation;  ///< why the winner won, in a few sentences

  const Candidate& winner() const { return candidates[best]; }
  /// The candidate of that name, or null.
  const Candidate* find(std::string_view name) const;
};

/// What a candidate is chosen by [m]: its depth error by the camera's choice or, where options ask
/// for robust codes, that on the worst perturbed camera, to which the decoder is calibrated; on
/// cameras with operating.multipath the error behind second returns is weighed in.
double choice_error_m(const Candidate& candidate, const Camera& camera,
                      const DesignOptions& options);

/// A candidate's depth error by the camera's choice: geometric mean over the operating points [m].
double chosen_error_m(const DepthErrorReport& report, DepthErrorKind kind);

/// Called for every designed code before it is judged, to keep finished work; may return a code
/// designed earlier for the same target, which is then used instead of designing again.
struct DesignStore {
  std::function<std::optional<Candidate>(const std::string& name)> load;
  std::function<void(const Candidate&)> save;
};

/// All candidates, the least chosen error first.
std::vector<const Candidate*> by_chosen_error(const DesignResult& result, DepthErrorKind kind);

/// How many times as large another candidate's chosen error is as the winner's, from the same
/// trials; the standard error takes the two for independent, which errs on the large side.
Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorKind kind);

/// Numbers of exposures that suit a method on a camera: fewer the more taps there are, more the
/// wider the band.
std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method);

/// Designs codes for `camera` by the methods asked for, lets all baselines compete and
/// picks by the camera's depth error. The naive code of every target (its ideal demodulation with
/// one pulse, where that is known and playable) competes too, so the winner is never worse than
/// naive.
/// @throws std::invalid_argument for bad options, an invalid camera, or targets it cannot play:
///         more than two taps, exposure times for another number of exposures, or a number of
///         samples that cannot represent a Hamiltonian code; Interrupted
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4 and 5
DesignResult design(const Camera& camera, const DesignOptions& options = {},
                    const Progress& progress = {}, const DesignStore& store = {});

}  // namespace tofsmith

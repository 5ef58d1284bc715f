// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/factorize.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// How the codes of a camera are designed and judged.
struct DesignOptions {
  /// Hamiltonian targets to factorize: number of exposures of each, 3 .. 6, each once.
  std::vector<int> exposures = {3, 4, 5};
  /// A target of the user's, factorized instead of the Hamiltonian ones.
  std::optional<TargetSet> target;
  FactorizeOptions factorize;
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

/// How one measurement of a designed code compares with its target.
struct MeasurementReport {
  double residual_rms = 0.0;           ///< of the pair chosen by depth error
  double smallest_residual_rms = 0.0;  ///< of the pair that comes closest to the target
  double demodulation_duty = 0.0;
  double modulation_duty = 0.0;
  double peak = 0.0;
  int edges = 0;                            ///< of modulation and demodulation together
  std::string start;                        ///< which start of the pool it came from
  std::vector<FactorizeIteration> history;  ///< as Factorization::history
};

/// A code that competes for the camera.
struct Candidate {
  CodeSet code;
  std::string method;      ///< "family", "naive" or "factorize"
  DepthErrorReport error;  ///< what evaluate() says of the code with the design's seed and trials
  int rotation_bin = 0;    ///< how far the origin was moved
  int iterations = 0;      ///< pairs of convex steps over all starts that led to it; 0 for a family
  double seconds = 0.0;    ///< time it took to design
  Eigen::MatrixXd target;  ///< what it was designed for (N, K); empty for a family
  std::vector<MeasurementReport> per_measurement;
  std::string message;  ///< one line on how near the target is
};

/// All candidates of a camera and which one is best by the camera's chosen depth error.
struct DesignResult {
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  std::vector<std::string> left_out;  ///< families the camera cannot play, with the reason

  const Candidate& winner() const { return candidates[best]; }
  /// The candidate of that name, or null.
  const Candidate* find(std::string_view name) const;
};

/// A candidate's depth error by the camera's choice: geometric mean over the operating points [m].
double chosen_error_m(const DepthErrorReport& report, DepthErrorKind kind);

/// Called for every designed code before it is judged, to keep finished work; may return a code
/// designed earlier for the same target, which is then used instead of designing again.
struct DesignStore {
  std::function<std::optional<Candidate>(const std::string& name)> load;
  std::function<void(const Candidate&)> save;
};

/// Designs codes for `camera` by factorizing correlation functions, lets all baselines compete and
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

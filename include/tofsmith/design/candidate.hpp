// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// One measurement of a designed code, with the residual to its target if it has one.
struct MeasurementReport {
  double residual_rms = 0.0;           ///< RMS residual of the selected pair; 0 without a target
  double smallest_residual_rms = 0.0;  ///< RMS residual of the pair nearest to the target
  double demodulation_duty = 0.0;
  double modulation_duty = 0.0;
  double peak = 0.0;
  int edges = 0;                            ///< total of modulation and demodulation
  std::string start;                        ///< name of the start in the pool that led to the pair
  std::vector<FactorizeIteration> history;  ///< see Factorization::history
};
/// Describes the fields (core/fields.hpp).
auto fields_of(ConstOrNot<MeasurementReport> auto& m) {
  return std::tuple(
      Field("residual_rms", m.residual_rms, at_least(0), FieldMark::may_be_null),
      Field("smallest_residual_rms", m.smallest_residual_rms, at_least(0), FieldMark::may_be_null),
      Field("demodulation_duty", m.demodulation_duty), Field("modulation_duty", m.modulation_duty),
      Field("peak", m.peak), Field("edges", m.edges, at_least(0)), Field("start", m.start),
      Field("history", m.history, FieldMark::apart));
}

/// Progress of a search after a given amount of work.
struct SearchStep {
  double work = 0.0;     ///< in SearchRecord::work_unit
  double error_m = 0.0;  ///< smallest error so far, as measured by the search
};
/// Describes the fields (core/fields.hpp).
auto fields_of(ConstOrNot<SearchStep> auto& s) {
  return std::tuple(Field("work", s.work), Field("error_m", s.error_m));
}

/// How a code was found.
struct SearchRecord {
  std::string work_unit;   ///< "gradient steps" or "candidates"
  std::string error_name;  ///< error measure of the steps
  std::vector<SearchStep> steps;
  bool proved = false;  ///< true if no other code of the searched kind is better
  std::string account;  ///< summary of the search: space, counts and pruning tests
};
/// Describes the fields (core/fields.hpp).
auto fields_of(ConstOrNot<SearchRecord> auto& s) {
  return std::tuple(Field("work_unit", s.work_unit), Field("error_name", s.error_name),
                    Field("steps", s.steps), Field("proved", s.proved),
                    Field("account", s.account));
}

/// A code that competes for a camera. The method that proposes a candidate sets the code and how it
/// was made; judge() (design/design.hpp) sets the rotation, the errors and the robustness.
struct Candidate {
  CodeSet code;
  /// "family", "naive", "reference", "atlas", "factorize", "optimize" or "search".
  std::string method;
  DepthErrorReport error;  ///< from evaluate() with the seed and the trials of DesignOptions
  int rotation_bin = 0;    ///< rotation of the origin of depth
  int iterations = 0;      ///< convex or gradient steps, over all starts that led to the code
  double seconds = 0.0;    ///< time used to design the code
  Eigen::MatrixXd target;  ///< target of the factorization (N, K); empty for other methods
  std::vector<MeasurementReport> per_measurement;  ///< one entry per demodulation; empty unless
                                                   ///< designed
  std::optional<SearchRecord> search;              ///< only for optimized and searched codes
  std::string message;                             ///< summary of the outcome in one line
  /// Errors on perturbed cameras: for the winner, or for all candidates with DesignOptions::robust.
  std::optional<RobustnessReport> robustness;

  /// Error in the operating multipath, on cameras with operating.multipath.
  std::optional<OperatingMultipathReport> multipath;

  /// Returns true if the code was designed for this camera. Families, reference, naive and atlas
  /// codes are not.
  bool is_designed() const { return !per_measurement.empty(); }
};

}  // namespace tofsmith

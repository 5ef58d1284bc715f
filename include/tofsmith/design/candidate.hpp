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
      Field("residual_rms", m.residual_rms, at_least(0), FieldMark::may_be_null),
      Field("smallest_residual_rms", m.smallest_residual_rms, at_least(0), FieldMark::may_be_null),
      Field("demodulation_duty", m.demodulation_duty), Field("modulation_duty", m.modulation_duty),
      Field("peak", m.peak), Field("edges", m.edges, at_least(0)), Field("start", m.start),
      Field("history", m.history, FieldMark::apart));
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

/// A code that competes for a camera. Makers fill in the code and how it came to be; origin, errors
/// and robustness are the judge's (judge() in design/design.hpp).
struct Candidate {
  CodeSet code;
  /// "family", "naive", "reference", "atlas", "factorize", "optimize" or "search".
  std::string method;
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

  /// Error in the operating multipath; on cameras with operating.multipath.
  std::optional<OperatingMultipathReport> multipath;

  /// Made for this camera, by any method; not a family, a reference, a naive code or one
  /// of the atlas.
  bool is_designed() const { return !per_measurement.empty(); }
};

}  // namespace tofsmith

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
#include "tofsmith/simulate/interference_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// Measurement of a designed code.
struct MeasurementReport {
  double residual_rms = 0.0;
  double smallest_residual_rms = 0.0;
  double demodulation_duty = 0.0;
  double modulation_duty = 0.0;
  double peak = 0.0;
  int edges = 0;
  std::string start;
  std::vector<FactorizeIteration> history;
};
auto fields_of(ConstOrNot<MeasurementReport> auto& m) {
  return std::tuple(
      Field("residual_rms", m.residual_rms, at_least(0), FieldMark::may_be_null,
            Help{"residual of the selected pair; 0 without a target"}),
      Field("smallest_residual_rms", m.smallest_residual_rms, at_least(0), FieldMark::may_be_null,
            Help{"residual of the pair nearest to the target"}),
      Field("demodulation_duty", m.demodulation_duty), Field("modulation_duty", m.modulation_duty),
      Field("peak", m.peak),
      Field("edges", m.edges, at_least(0), Help{"number in modulation and demodulation"}),
      Field("start", m.start, Help{"name of the start"}),
      Field("history", m.history, FieldMark::apart));
}

struct SearchStep {
  double work = 0.0;
  double error_m = 0.0;
};
auto fields_of(ConstOrNot<SearchStep> auto& s) {
  return std::tuple(Field("work", s.work, Help{"work at each step, in work_unit"}),
                    Field("error_m", s.error_m, Help{"smallest error yet"}));
}

/// How a code was found.
struct SearchRecord {
  std::string work_unit;
  std::string error_name;
  std::vector<SearchStep> steps;
  bool proved = false;
  std::string account;
};
auto fields_of(ConstOrNot<SearchRecord> auto& s) {
  return std::tuple(
      Field("work_unit", s.work_unit, Help{"unit of work: gradient steps or candidates"}),
      Field("error_name", s.error_name), Field("steps", s.steps),
      Field("proved", s.proved, Help{"true if no other code of the search space is better"}),
      Field("account", s.account, Help{"search space, counts and pruning tests"}));
}

/// Order of exposures that a design chose for moving surfaces.
struct ExposureOrder {
  std::vector<int> order;
  double rms_bias_m = 0.0;
  double given_rms_bias_m = 0.0;
};
auto fields_of(ConstOrNot<ExposureOrder> auto& o) {
  return std::tuple(Field("order", o.order, at_least(0),
                          Help{"for each exposure, its number in the proposed code, from 0"}),
                    Field("rms_bias_m", o.rms_bias_m, at_least(0),
                          Help{"root mean square depth error due to motion, in this order"}),
                    Field("given_rms_bias_m", o.given_rms_bias_m, at_least(0),
                          Help{"the same in the order of the proposed code"}));
}

/// A code that competes for a camera. Methods set the code and its origin; judge()
/// (design/design.hpp) sets exposure order, rotation, errors and robustness.
struct Candidate {
  CodeSet code;
  /// "family", "naive", "reference", "atlas", "factorize", "optimize", "search" or "frequencies".
  std::string method;
  /// By evaluate(), with the seed and up to 12 times the trials of DesignOptions.
  DepthErrorReport error;
  int rotation_bin = 0;  ///< of the origin of depth
  int iterations = 0;    ///< convex or gradient steps, over all starts
  double seconds = 0.0;
  Eigen::MatrixXd target;                          ///< of the factorization (N, K); else empty
  std::vector<MeasurementReport> per_measurement;  ///< per demodulation; empty unless designed
  std::optional<SearchRecord> search;              ///< of optimized and searched codes
  std::string message;                             ///< outcome in one line
  /// Errors on perturbed cameras; for the winner, or for all with DesignOptions::robust.
  std::optional<RobustnessReport> robustness;

  /// Error in operating.multipath.
  std::optional<OperatingMultipathReport> multipath;

  /// Error with the light of other cameras, if the camera has operating.interference.
  std::optional<InterferenceReport> interference = {};

  /// Order of the exposures of `code`, if the camera has operating.velocity_m_per_s.
  std::optional<ExposureOrder> exposure_order = {};

  /// Returns true if the code was designed for this camera.
  bool is_designed() const { return !per_measurement.empty(); }
};

}  // namespace tofsmith

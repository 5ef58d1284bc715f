// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/wrong_shares.hpp"

namespace tofsmith {

/// Movement of a surface along the ray from the middle of a frame to the middle of each exposure
/// [m], in the order of capture.
/// @param velocity_m_per_s  positive: away from the camera
/// @throws std::invalid_argument if the camera lists times for another number of exposures
Eigen::VectorXd exposure_shifts_m(const CodeSet& code, const Camera& camera,
                                  double velocity_m_per_s);
/// For cameras that list exposure times.
Eigen::VectorXd exposure_shifts_m(const Camera& timed, double velocity_m_per_s);

/// Depth error that DecodeMethod::zncc makes without noise if each exposure sees another depth, to
/// first order in the shifts d_e of the exposures:
///   error(z) = sum_e c_e(z) d_e,   c_e = sum_(i in e) g_i x'_i / |g|^2,   sum_e c_e = 1,
/// where x' is the derivative of the expected measurements and g is its component orthogonal to the
/// derivatives with respect to signal and ambient light.
class MotionBias {
 public:
  /// @param camera  the camera of `model`
  MotionBias(const ForwardModel& model, const Camera& camera);

  int exposures() const { return static_cast<int>(mean_share_.size()); }
  /// Mean over depths [m]. @param shift_m  (exposures)
  double mean_m(const Eigen::VectorXd& shift_m) const { return mean_share_.dot(shift_m); }
  /// Root mean square over depths [m]. @param shift_m  (exposures)
  double rms_m(const Eigen::VectorXd& shift_m) const;

 private:
  Eigen::VectorXd mean_share_;    // mean of c
  Eigen::MatrixXd mean_product_;  // mean of c c^T
};

/// Errors at one operating point.
struct MotionPoint {
  OperatingPoint point;
  Estimate circular_mde_m;
  Estimate bias_m;
  WrongShares shares;
};
auto fields_of(ConstOrNot<MotionPoint> auto& p) {
  return std::tuple(Field("point", p.point, FieldMark::in_place),
                    Field("circular_mde_m", p.circular_mde_m, at_least(0),
                          Help{"mean distance from the nearest true depth, wrapped"}),
                    Field("bias_m", p.bias_m, Help{"mean difference from the nearest true depth"}),
                    Field("shares", p.shares, FieldMark::in_place));
}

struct MotionErrors {
  Estimate geometric_mean_m;
  WrongShares shares;
  std::vector<MotionPoint> points;  ///< in the order of OperatingRange::points()
};
auto fields_of(ConstOrNot<MotionErrors> auto& e) {
  return std::tuple(
      Field("geometric_mean_m", e.geometric_mean_m, at_least(0),
            Help{"geometric mean over the operating points of the circular error"}),
      Field("shares", e.shares, FieldMark::in_place, Help{"means over the operating points"}),
      Field("points", e.points));
}

/// Effect of motion while the exposures of a frame follow one another.
struct MotionReport {
  double velocity_m_per_s = 0.0;
  double rms_bias_m = 0.0;   ///< MotionBias::rms_m()
  double mean_bias_m = 0.0;  ///< MotionBias::mean_m()
  MotionErrors surface;
  MotionErrors edge;
};
auto fields_of(ConstOrNot<MotionReport> auto& r) {
  return std::tuple(
      Field("velocity_m_per_s", r.velocity_m_per_s),
      Field("rms_bias_m", r.rms_bias_m, at_least(0),
            Help{"root mean square depth error of a moving surface without noise, over all depths, "
                 "to first order in the velocity"}),
      Field("mean_bias_m", r.mean_bias_m, Help{"mean of the same error"}),
      Field("surface", r.surface,
            Help{"errors of a moving surface; its true depth is its depth in the middle of the "
                 "frame"}),
      Field("edge", r.edge,
            Help{"errors at an edge that passes between two exposures; the true depths are the "
                 "depths of both surfaces. Codes with one exposure have no operating points"}));
}

/// Computes the depth error of a surface that moves along the ray, and of an edge that passes
/// between two exposures, by Monte Carlo simulation with the decoder of `options.method`.
///
/// Each exposure sees the depth in its middle; the signal does not depend on the depth. Depths are
/// drawn as by evaluate(). For an edge, the second surface is drawn from the same distribution, and
/// the number of exposures that see the first one is uniform.
/// @param options  trials, seed, method and unwrap_weights are used
/// @throws InvalidArgument as evaluate(); Interrupted
/// @note same bits for any number of threads
MotionReport motion_error(const CodeSet& code, const Camera& camera, double velocity_m_per_s,
                          const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith

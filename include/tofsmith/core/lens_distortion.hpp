// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Distortion formulas of OpenCV and the Azure Kinect SDK.
enum class DistortionModel {
  opencv,        ///< radial (rational), tangential and thin prism, of x/z and y/z
  fisheye,       ///< polynomial of the angle from the axis
  rational_6kt,  ///< Azure Kinect: radial (rational), with another tangential term
};

constexpr auto words_of(DistortionModel /*any*/) {
  return word_list("opencv", "fisheye", "rational-6kt");
}

/// Moves image points from their ideal pinhole position. Positions are in the plane z = 1: x/z and
/// y/z of an ideal ray, and (u - cx) / fx, (v - cy) / fy of a pixel.
///
///   opencv   x' = x R + 2 p1 x y + p2 (r^2 + 2 x^2) + s1 r^2 + s2 r^4
///            y' = y R + p1 (r^2 + 2 y^2) + 2 p2 x y + s3 r^2 + s4 r^4
///            R = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   rational-6kt  as opencv without thin prism, with p1 x y for 2 p1 x y and p2 x y for 2 p2 x y
///   fisheye  r' = a + k1 a^3 + k2 a^5 + k3 a^7 + k4 a^9,  a = atan r, same direction
///
/// The inverse is defined up to the radius at which distorted positions stop moving outwards.
/// @see OpenCV 4, module calib3d: projectPoints() and fisheye::projectPoints(); Azure Kinect Sensor
///      SDK, src/transformation/intrinsic_transformation.c
struct LensDistortion {
  DistortionModel model = DistortionModel::opencv;
  /// opencv: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [0 0]]]]; fisheye: k1 k2 k3 k4; rational-6kt:
  /// k1 k2 p1 p2 k3 k4 k5 k6. Missing ones are 0. The tilt of the sensor, the last two of opencv,
  /// must be 0.
  std::vector<double> coefficients;
  /// Largest radius at z = 1 for which the formulas hold; default: until the distortion folds back.
  std::optional<double> max_radius = {};

  Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// Returns the ideal position; none beyond a fold, beyond max_radius, or at 90 degrees or more
  /// from the axis (fisheye).
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;
  /// Returns the fraction of the line from the axis to `distorted` on which undistort() succeeds; 1
  /// also up to max_radius.
  double reach(const Eigen::Vector2d& distorted) const;

  /// @throws InvalidArgument if the number of coefficients is wrong, one is not finite, or the
  ///         sensor is tilted
  void validate(std::string_view field) const;

  friend bool operator==(const LensDistortion&, const LensDistortion&) = default;
};

/// Keys of [lens] and of the view in a scene file.
/// @param has_model, has_coefficients  false: `condition` is not met
inline void describe(FieldVisitor& fields, LensDistortion& distortion, bool has_model = true,
                     bool has_coefficients = true, std::string_view condition = {}) {
  fields.choice(Key("distortion_model", "Formulas of the distortion").only(has_model, condition),
                distortion.model);
  fields.value(Key("distortion",
                   "Coefficients in the order of OpenCV's calibrateCamera() or "
                   "fisheye::calibrate()",
                   finite())
                   .required("[-0.3, 0.1, 0.0, 0.0]")
                   .only(has_coefficients, condition),
               distortion.coefficients);
  fields.value(Key("distortion_max_radius",
                   "Largest distance of rays from the optical axis at z = 1; pixels beyond it are "
                   "invalid",
                   above(0))
                   .only(has_coefficients, condition),
               distortion.max_radius);
}

}  // namespace tofsmith

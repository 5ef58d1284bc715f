// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// By which formulas a lens distorts; both are OpenCV's.
enum class DistortionModel {
  opencv,   ///< radial (rational), tangential and thin prism, of x/z and y/z
  fisheye,  ///< a polynomial of the angle off the axis
};

/// Words for the enumerators, in their order.
inline constexpr std::array<std::string_view, 2> distortion_models = {"opencv", "fisheye"};
/// "opencv", "fisheye".
std::string_view name_of(DistortionModel model);
/// @throws std::invalid_argument for any other word
DistortionModel parse_distortion_model(std::string_view word);

/// How a lens moves the image of a point away from where an ideal pinhole has it. Places are those
/// in the plane z = 1: x/z and y/z of an ideal ray, and (u - cx) / fx, (v - cy) / fy of a pixel.
///
///   opencv   x' = x R + 2 p1 x y + p2 (r^2 + 2 x^2) + s1 r^2 + s2 r^4
///            y' = y R + p1 (r^2 + 2 y^2) + 2 p2 x y + s3 r^2 + s4 r^4
///            R = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   fisheye  r' = a + k1 a^3 + k2 a^5 + k3 a^7 + k4 a^9,  a = atan r, the same direction
///
/// A ray belongs to a place only as far as places move outwards with their rays: where the
/// distortion folds back, several rays would meet one place.
/// @see OpenCV 4, modules calib3d: projectPoints() and fisheye::projectPoints()
struct LensDistortion {
  DistortionModel model = DistortionModel::opencv;
  /// opencv: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]]; fisheye: k1 k2 k3 k4. Those left out are 0.
  std::vector<double> coefficients;

  /// Where the image of an ideal place falls.
  Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// Whose image falls there; none where the distortion folds back before, or a fisheye looks 90
  /// degrees off the axis or more.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;
  /// How much of the way from the axis to `distorted` undistort() can go, in [0, 1]; 1: all of it.
  double reach(const Eigen::Vector2d& distorted) const;

  /// @throws std::invalid_argument naming `field`, value and rule: how many numbers there are, and
  ///         that they are finite
  void validate(std::string_view field) const;

  friend bool operator==(const LensDistortion&, const LensDistortion&) = default;
};

/// Keys of [lens] and of the view of a scene file.
/// @param has_model, has_coefficients  false: `condition` is not met
inline void describe(FieldVisitor& fields, LensDistortion& distortion, bool has_model = true,
                     bool has_coefficients = true, std::string_view condition = {}) {
  fields.choice(Key("distortion_model", "Formulas of the distortion").only(has_model, condition),
                distortion.model, distortion_models);
  fields.value(Key("distortion",
                   "Coefficients in the order of OpenCV's calibrateCamera() or "
                   "fisheye::calibrate()",
                   finite())
                   .required("[-0.3, 0.1, 0.0, 0.0]")
                   .only(has_coefficients, condition),
               distortion.coefficients);
}

}  // namespace tofsmith

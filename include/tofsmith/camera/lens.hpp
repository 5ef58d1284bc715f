// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/lens_distortion.hpp"

namespace tofsmith {

/// Sensors with several frame modes that crop or bin the image; the frame size identifies the mode.
enum class FrameModes {
  azure_kinect,  ///< 640 x 576, 320 x 288, 512 x 512 or 1024 x 1024 of 1024 x 1024 pixels
};

/// Names of the enumerators, in their order.
inline constexpr std::array<std::string_view, 1> frame_modes_words = {"azure-kinect"};

/// Pinhole model of the sensor and distortion of its lens. Required for point clouds and for
/// conversions between z-depth and radial distance.
struct Lens {
  double fx_px = 0.0;                                ///< focal length in columns [px]
  double fy_px = 0.0;                                ///< focal length in rows [px]
  double cx_px = 0.0;                                ///< column of the optical axis [px]
  double cy_px = 0.0;                                ///< row of the optical axis [px]
  std::optional<LensDistortion> distortion = {};     ///< none: ideal pinhole
  std::optional<int> width_px = {}, height_px = {};  ///< image size [px]; none: any
  std::optional<FrameModes> frame_modes = {};        ///< none: frames are whole images
  /// Path of a NumPy array (.npy) with the ray of each pixel, which replaces all other members:
  /// shape (H, W, 2) with x/z and y/z, or (H, W, 3) with directions. NaN marks pixels without a
  /// ray. Empty: pinhole.
  std::string rays = {};

  friend bool operator==(const Lens&, const Lens&) = default;
};

/// Keys of [lens] that describe the pinhole. `calibration` names a file that replaces most of them,
/// `calibration_camera` selects one of its cameras. load_camera() and similar functions read the
/// file.
inline void describe(FieldVisitor& fields, Lens& lens) {
  fields.value(Key("rays", "File with the ray of each pixel (.npy), instead of a pinhole"),
               InputPath{lens.rays});
  const bool has_rays = !lens.rays.empty();
  std::string calibration;
  fields.value(Key("calibration",
                   "Calibration file of OpenCV, ROS, Kalibr or an Azure Kinect, instead of the "
                   "numbers")
                   .only(!has_rays, "no rays"),
               InputPath{calibration});
  std::optional<std::string> camera;
  fields.value(Key("calibration_camera", "Camera of a calibration file with several cameras")
                   .only(!calibration.empty(), "calibration"),
               camera);
  const bool is_pinhole = !has_rays && calibration.empty();
  const std::string_view condition = has_rays ? "no rays" : "no calibration";
  fields.value(Key("fx_px", "Focal length in columns", above(0))
                   .required("525.0")
                   .only(is_pinhole, condition),
               lens.fx_px);
  fields.value(
      Key("fy_px", "Focal length in rows", above(0)).required("525.0").only(is_pinhole, condition),
      lens.fy_px);
  fields.value(Key("cx_px", "Column of the optical axis", finite())
                   .required("319.5")
                   .only(is_pinhole, condition),
               lens.cx_px);
  fields.value(Key("cy_px", "Row of the optical axis", finite())
                   .required("239.5")
                   .only(is_pinhole, condition),
               lens.cy_px);
  fields.part(Key("distortion", "Distortion of the lens"), lens.distortion,
              [&](FieldVisitor& inner, LensDistortion& distortion) {
                describe(inner, distortion, !has_rays, is_pinhole, condition);
              });
  fields.value(
      Key("width_px", "Width of the images; frames of another size are rejected", at_least(1))
          .only(is_pinhole, condition),
      lens.width_px);
  fields.value(
      Key("height_px", "Height of the images; frames of another size are rejected", at_least(1))
          .only(is_pinhole, condition),
      lens.height_px);
  Key modes("frame_modes",
            "Sensor with several frame sizes, which are crops or binned images; the pinhole "
            "describes the whole sensor");
  modes.only(is_pinhole, condition);
  fields.part(modes, lens.frame_modes, [&](FieldVisitor& inner, FrameModes& sensor) {
    inner.choice(modes, sensor, frame_modes_words);
  });
}

/// Optical blur of the image in simulations, and its sampling. The blur applies to light, not to
/// depth: the expected electrons of a pixel are a weighted sum over many rays.
struct LensBlur {
  enum class Kind {
    none,      ///< no blur
    gaussian,  ///< Gaussian point spread function
    disc,      ///< disc of confusion of a thin lens, which depends on distance
  };
  Kind kind = Kind::none;
  double blur_sigma_px = 0.0;     ///< gaussian: standard deviation in each direction [px]
  double focal_length_m = 0.0;    ///< disc: f [m]
  double f_number = 0.0;          ///< disc: focal length over aperture
  double focus_distance_m = 0.0;  ///< disc: distance in focus [m], > focal length
  double pixel_pitch_m = 0.0;     ///< disc: distance between pixel centres [m]
  /// n: scenes made of shapes are sampled with n x n rays, evenly spaced over each pixel; 1: one
  /// ray through the pixel centre. Depth images always have one value per pixel.
  int pixel_samples = 1;

  /// Returns true if every pixel samples only the ray through its centre.
  bool is_sharp() const { return kind == Kind::none && pixel_samples == 1; }

  /// Returns the radius of the disc of confusion at a distance [px]; NaN means infinitely far.
  ///   r = f^2 / (2 k (z_f - f)) |1 - z_f / z| / pitch,  k: f-number, z_f: focus distance
  double disc_radius_px(double distance_m) const;

  /// @throws std::invalid_argument naming the field as lens.*, value and rule
  void validate() const;

  friend bool operator==(const LensBlur&, const LensBlur&) = default;
};

/// Names of the kinds of blur, in the order of the enumerators.
inline constexpr std::array<std::string_view, 3> lens_blur_kinds = {"none", "gaussian", "disc"};

/// Keys of [lens] that describe the blur.
inline void describe(FieldVisitor& fields, LensBlur& blur) {
  using Kind = LensBlur::Kind;
  fields.choice(Key("blur", "Point spread function of the lens in simulations"), blur.kind,
                lens_blur_kinds);
  fields.value(Key("blur_sigma_px",
                   "Standard deviation of the point spread function in each "
                   "direction",
                   left_open(0, 32))
                   .required("0.5")
                   .only(blur.kind == Kind::gaussian, "blur = \"gaussian\""),
               blur.blur_sigma_px);
  const bool is_disc = blur.kind == Kind::disc;
  const std::string_view disc = "blur = \"disc\"";
  fields.value(Key("focal_length_m", "Focal length", above(0)).required("4e-3").only(is_disc, disc),
               blur.focal_length_m);
  fields.value(Key("f_number", "Focal length divided by the aperture", above(0))
                   .required("1.4")
                   .only(is_disc, disc),
               blur.f_number);
  fields.value(
      Key("focus_distance_m", "Distance in focus", above(0)).required("1.0").only(is_disc, disc),
      blur.focus_distance_m);
  fields.value(Key("pixel_pitch_m", "Distance between pixel centres", above(0))
                   .required("10e-6")
                   .only(is_disc, disc),
               blur.pixel_pitch_m);
  fields.value(Key("pixel_samples",
                   "n: scenes made of shapes are sampled with n x n rays per pixel", closed(1, 16)),
               blur.pixel_samples);
}

}  // namespace tofsmith

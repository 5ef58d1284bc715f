// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/lens_distortion.hpp"

namespace tofsmith {

/// Sensors with frame modes that crop or bin the image. The frame size identifies the mode.
enum class FrameModes {
  azure_kinect,  ///< 640 x 576, 320 x 288, 512 x 512 or 1024 x 1024 of 1024 x 1024 pixels
};

constexpr auto words_of(FrameModes /*any*/) { return word_list("azure-kinect"); }

/// Pinhole model of the sensor with lens distortion, for point clouds and conversions between
/// z-depth and radial distance.
struct Lens {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::optional<LensDistortion> distortion = {};     ///< none: ideal pinhole
  std::optional<int> width_px = {}, height_px = {};  ///< none: any
  std::optional<FrameModes> frame_modes = {};        ///< none: frames are whole images
  /// Path of a .npy array with the ray of each pixel, which replaces all other members: (H, W, 2)
  /// with x/z and y/z, or (H, W, 3) with directions. NaN: no ray. Empty: pinhole.
  std::string rays = {};

  friend bool operator==(const Lens&, const Lens&) = default;
};

/// Keys of [lens] that describe the pinhole. load_camera() and similar functions read the file
/// `calibration`, which replaces most of them.
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
            "Sensor whose smaller frames are cropped or binned; the pinhole parameters are "
            "those of the whole sensor");
  modes.only(is_pinhole, condition);
  fields.part(modes, lens.frame_modes,
              [&](FieldVisitor& inner, FrameModes& sensor) { inner.choice(modes, sensor); });
}

/// Blur of simulated images and its sampling. It applies to light, not to depth: the expected
/// electrons of a pixel are a weighted sum over many rays.
struct LensBlur {
  enum class Kind {
    none,
    gaussian,  ///< Gaussian point spread function
    disc,      ///< disc of confusion of a thin lens
  };
  Kind kind = Kind::none;
  double blur_sigma_px = 0.0;     ///< gaussian: standard deviation in each direction
  double focal_length_m = 0.0;    ///< disc
  double f_number = 0.0;          ///< disc
  double focus_distance_m = 0.0;  ///< disc: distance in focus, > focal length
  double pixel_pitch_m = 0.0;     ///< disc: distance between pixel centres
  /// n: shapes are sampled with n x n rays per pixel; 1: one ray through the centre.
  int pixel_samples = 1;

  bool is_sharp() const { return kind == Kind::none && pixel_samples == 1; }

  /// Returns the radius of the disc of confusion [px]; a NaN distance is infinite.
  ///   r = f^2 / (2 k (z_f - f)) |1 - z_f / z| / pitch,  k: f-number, z_f: focus distance
  double disc_radius_px(double distance_m) const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const LensBlur&, const LensBlur&) = default;
};

constexpr auto words_of(LensBlur::Kind /*any*/) { return word_list("none", "gaussian", "disc"); }

/// Keys of [lens] that describe the blur.
inline void describe(FieldVisitor& fields, LensBlur& blur) {
  using Kind = LensBlur::Kind;
  fields.choice(Key("blur", "Point spread function of the lens in simulations"), blur.kind);
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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Options of photon_transfer().
struct PhotonTransferOptions {
  std::optional<double> black_level_dn;
  std::optional<int> adc_bits;
  double averaged = 1.0;

  /// @throws InvalidArgument
  void validate() const { check_fields(*this); }
};
auto fields_of(ConstOrNot<PhotonTransferOptions> auto& o) {
  return std::tuple(
      Field("black_level_dn", o.black_level_dn, at_least(0), Help{"black level, if known"},
            IfAbsent{"from dark frames, otherwise the camera's"}),
      Field("adc_bits", o.adc_bits, closed(1, 24), Help{"resolution of the raw numbers"},
            IfAbsent{"the camera's, or the smallest usual one"}),
      Field("averaged", o.averaged, above(0),
            Help{"number of frames averaged in each recorded frame"}));
}

/// Mean and variance of one measurement in a pair of frames.
struct PhotonTransferPoint {
  double mean_dn = 0.0;
  Estimate variance_dn2;
  bool dark = false;
  bool saturated = false;
};
auto fields_of(ConstOrNot<PhotonTransferPoint> auto& p) {
  return std::tuple(
      Field("mean_dn", p.mean_dn,
            Help{"mean over both frames and all pixels; for differences the light of both "
                 "buckets"}),
      Field("variance_dn2", p.variance_dn2, FieldMark::as_object,
            Help{"temporal variance of one frame [DN^2]; for differences of numbers with about "
                 "the same light"}),
      Field("dark", p.dark, Help{"the point is of the dark frames"}),
      Field("saturated", p.saturated, Help{"too close to the limit for the fit"}));
}

/// Noise of a sensor from pairs of frames with the same light:
///   variance [DN^2] = read_noise^2 / gain^2 + (mean - black) / gain + 1/12
struct PhotonTransfer {
  Estimate gain_e_per_dn;
  Estimate read_noise_e;
  Estimate black_level_dn;
  std::optional<Estimate> full_well_e;
  double saturation_dn = 0.0;
  int adc_bits = 0;
  int buckets = 1;
  double reduced_chi2 = 0.0;
  std::vector<PhotonTransferPoint> points;
  std::vector<std::string> notes;
};
auto fields_of(ConstOrNot<PhotonTransfer> auto& p) {
  return std::tuple(
      Field("gain_e_per_dn", p.gain_e_per_dn, FieldMark::as_object, Help{"gain"}),
      Field("read_noise_e", p.read_noise_e, FieldMark::as_object, Help{"read noise"}),
      Field("black_level_dn", p.black_level_dn, FieldMark::as_object, Help{"black level"}),
      Field("full_well_e", p.full_well_e, FieldMark::as_object,
            Help{"full well, if reached below the converter's maximum"}),
      Field("saturation_dn", p.saturation_dn,
            Help{"number at which values are clipped, or the highest number"}),
      Field("adc_bits", p.adc_bits),
      Field("buckets", p.buckets, Help{"buckets per raw number: 2 if differences are read"}),
      Field("reduced_chi2", p.reduced_chi2,
            Help{"misfit of the line: near 1 if the model is valid"}),
      Field("points", p.points, FieldMark::as_object), Field("notes", p.notes));
}

/// Computes gain and read noise by the photon transfer method (EMVA 1288) from pairs of consecutive
/// frames, which must have the same light. The black level is the mean of the dark frames, or
/// given. The full well is a number below the converter's maximum at which pixels accumulate.
/// @param levels  one recording per light level, or one of all levels: raw numbers of single taps,
///         an even number of frames
/// @param dark    frames without light; may be empty if the black level is given
/// @throws InvalidArgument if frames are not paired, sizes differ, the black level is unknown, or
///         the levels do not differ
/// @see docs/calibration.md
PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const PhotonTransferOptions& options = {});

/// Computes the noise of a camera that reads the differences of two buckets. Their mean does not
/// determine the shot noise, so the light of both buckets follows from the code at the decoded
/// depth:
///   light_k       = T_k S shot_chi_k(z) [DN]
///   variance_k    = 2 read_noise^2 / gain^2 + light_k / gain + 2/12 [DN^2]
/// Pixels are used if the difference exceeds its noise by a factor of 8 and, if `adc_bits` is
/// given, their buckets (with `black_level_dn`) stay 5 % below the converter's maximum. There
/// should be no ambient light.
/// @param table  of the code on the camera
/// @throws InvalidArgument also if the number of measurements differs from the code's
PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const DecodingTable& table,
                               const PhotonTransferOptions& options = {});

/// Returns the camera with the calibrated gain, read noise, black level, bits and full well.
Camera with_noise(Camera camera, const PhotonTransfer& found);

}  // namespace tofsmith

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

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const { check_fields(*this); }
};
auto fields_of(ConstOrNot<PhotonTransferOptions> auto& o) {
  return std::tuple(
      Field("black_level_dn", o.black_level_dn, at_least(0), Help{"black level, if known"},
            IfAbsent{"from dark frames, or the camera's"}),
      Field("adc_bits", o.adc_bits, closed(1, 24), Help{"resolution of the raw numbers"},
            IfAbsent{"the camera's, or the smallest usual one"}),
      Field("averaged", o.averaged, above(0),
            Help{"number of equal frames that each frame is already the mean of"}));
}

/// Mean and variance of one pair of frames of one measurement; of differences, of those that
/// collected about the same light.
struct PhotonTransferPoint {
  double mean_dn = 0.0;    ///< over both frames and all pixels; of differences the light [DN]
  Estimate variance_dn2;   ///< of one frame in time [DN^2]
  bool dark = false;       ///< of the dark frames
  bool saturated = false;  ///< too close to the limit to count in the fit
};

/// Noise of a sensor from pairs of frames of the same light:
///   variance [DN^2] = read_noise^2 / gain^2 + (mean - black) / gain + 1/12
struct PhotonTransfer {
  Estimate gain_e_per_dn;               ///< [e/DN]
  Estimate read_noise_e;                ///< [e]
  Estimate black_level_dn;              ///< [DN]
  std::optional<Estimate> full_well_e;  ///< [e], if frames reach it before the converter's end
  double saturation_dn = 0.0;           ///< highest number seen, or where numbers are clipped
  int adc_bits = 0;
  int buckets = 1;            ///< that a raw number is of: 2 where differences are read
  double reduced_chi2 = 0.0;  ///< of the fit: near 1 where the model holds
  std::vector<PhotonTransferPoint> points;
  std::vector<std::string> notes;
};

/// Photon transfer. Each two frames of a recording that follow one another saw the same light; the
/// difference of the two leaves out what is fixed in a pixel, half its variance is that in time.
/// The darkest and dark frames fix read noise, the rise of variance with the mean the gain.
///   1. Black level: mean of the dark frames, or as given.
///   2. Mean and variance of every pair and measurement; a change of light between the two frames
///      of a pair is taken out.
///   3. Full well: where pixels pile up at one number below the converter's last.
///   4. Straight line by weighted least squares, weights from the expected variance; read noise
///      from its value at black, less 1/12 of rounding.
/// @param levels  one recording per level of light or one of them all, raw numbers of single taps
///                (not differences), an even number of frames
/// @param dark    frames without light; may have no frames if the black level is given
/// @throws std::invalid_argument if frames are no pairs, sizes differ, the black level is unknown,
///         or the levels do not differ
PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const PhotonTransferOptions& options = {});

/// The same of a camera that reads the differences of two buckets, whose mean says nothing of shot
/// noise: both together collected the light that the code asks for where a pixel decodes to.
///   light_k       = T_k S shot_chi_k(z) [DN]
///   variance_k    = 2 read_noise^2 / gain^2 + light_k / gain + 2/12 [DN^2]
/// Pixels count whose difference is 8 times its noise and, if `adc_bits` is given, whose buckets
/// (with `black_level_dn`) stay 5 % below the converter's last number; the weaker light of one
/// frame of a pair is taken out. Light from elsewhere is not known, so there should be none.
/// @param table  of the code on the camera
/// @throws std::invalid_argument also if measurements are not the code's
PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const DecodingTable& table,
                               const PhotonTransferOptions& options = {});

/// The camera with what was found: gain, read noise, black level, bits and full well.
Camera with_noise(Camera camera, const PhotonTransfer& found);

}  // namespace tofsmith

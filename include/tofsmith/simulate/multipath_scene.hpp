// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/decode/multipath_image.hpp"
#include "tofsmith/decode/multipath_options.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/simulate/multipath_capture.hpp"

namespace tofsmith {

/// Depth of a scene as one decoder sees it.
struct MultipathSceneDecoding {
  std::string method;    ///< "single-path", "two-return"
  Image<float> depth_m;  ///< NaN: none
  Image<float> error_m;  ///< decoded - true, the shorter way round; NaN where unknown
};

/// Pixels whose later light comes about as late, and how far off decoders are there.
struct DelayClass {
  double from_m = 0.0, to_m = 0.0;  ///< mean delay of the later light
  std::int64_t pixels = 0;
  double ratio = 0.0;           ///< mean of later light over direct light
  std::vector<double> bias_m;   ///< mean of decoded - true, of each decoding
  std::vector<double> error_m;  ///< mean of |decoded - true|
  double two_share = 0.0;       ///< found to hold two returns
  double unresolved_share = 0.0;
};

/// A scene whose surfaces light each other, captured once and decoded as single-path and as two
/// returns.
struct MultipathScene {
  std::string name, code;
  SceneImage truth;
  PinholeView view;
  CaptureOptions light;
  Image<float> later_ratio;    ///< all later light over direct light; 0: none; NaN: no return
  Image<float> later_delay_m;  ///< mean delay of the later light; NaN: none
  std::vector<MultipathSceneDecoding> decodings;  ///< single-path, then two-return
  Image<ReturnStatus> returns;                    ///< of two-return decoding
  std::vector<DelayClass> classes;                ///< by mean delay; those without pixels left out
  DelayClass all;                                 ///< all pixels with later light
};

/// Captures and decodes. Pixels without later light are in no class.
/// @throws std::invalid_argument as capture(), TwoReturnDecoder and returns.validate(); Interrupted
MultipathScene multipath_scene(std::string name, const SceneImage& truth, const PinholeView& view,
                               const LaterReturns& returns, const CodeSet& code,
                               const Camera& camera, const CaptureOptions& light,
                               const MultipathOptions& decoding = {},
                               const Progress& progress = {});

}  // namespace tofsmith

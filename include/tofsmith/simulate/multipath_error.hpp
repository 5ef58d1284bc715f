// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Decoded depth of a scene.
struct MultipathSceneDecoding {
  std::string method;  ///< "single-path", "two-return"
  Image<float> depth_m;
  Image<float> error_m;  ///< wrapped; NaN where unknown
};

/// Errors in pixels with a similar delay of the multipath light.
struct DelayClass {
  double from_m = 0.0, to_m = 0.0;  ///< mean delay
  std::int64_t pixels = 0;
  double ratio = 0.0;
  std::vector<double> bias_m;   ///< mean error, per decoder
  std::vector<double> error_m;  ///< mean |error|
  double two_share = 0.0;       ///< share of pixels with two returns
  double unresolved_share = 0.0;
};

/// A scene with interreflections, decoded by a single-path and a two-return decoder.
struct MultipathScene {
  std::string name, code;
  SceneImage truth;
  PinholeView view;
  CaptureOptions light;
  Image<float> multipath_ratio;                   ///< 0: none; NaN: no return
  Image<float> multipath_delay_m;                 ///< mean; NaN: none
  std::vector<MultipathSceneDecoding> decodings;  ///< single-path, then two-return
  Image<ReturnStatus> returns;
  std::vector<DelayClass> classes;  ///< without empty classes
  DelayClass all;                   ///< pixels with multipath light
};

/// Captures and decodes the scene.
/// @throws std::invalid_argument as capture(), TwoReturnDecoder and returns.validate(); Interrupted
MultipathScene multipath_scene(std::string name, const SceneImage& truth, const PinholeView& view,
                               const MultipathReturns& returns, const CodeSet& code,
                               const Camera& camera, const CaptureOptions& light,
                               const MultipathOptions& decoding = {},
                               const Progress& progress = {});

/// Multipath light to simulate.
struct MultipathErrorOptions {
  std::vector<double> delay_m = {0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0};
  std::vector<double> ratio = {0.1, 0.3, 0.6};  ///< S2 / S1
  std::vector<double> tail_m = {0.25, 0.5, 1.0};
  std::vector<double> signal_e_per_s = {1e4, 1e5};  ///< S1
  double ambient_e_per_s = 1e4;                     ///< A
  std::int64_t trials = 2000;
  std::uint64_t seed = 1;
  MultipathOptions decoding;  ///< tail_m is replaced by each tail

  /// @throws std::invalid_argument
  void validate(double range_m) const;
};
auto fields_of(ConstOrNot<MultipathErrorOptions> auto& o) {
  return std::tuple(
      Field("delay_m", o.delay_m, above(0), Help{"delays of the second return"}),
      Field("ratio", o.ratio, closed(0, 1), Help{"ratios of the second return to the direct one"}),
      Field("tail_m", o.tail_m, above(0), Help{"mean delays of exponential tails"}),
      Field("signal_e_per_s", o.signal_e_per_s, above(0), Help{"light of the direct return"}),
      Field("ambient_e_per_s", o.ambient_e_per_s, at_least(0), Help{"ambient light"}),
      Field("trials", o.trials, closed(2, 1e7),
            Help{"trials per combination of signal, delay and ratio"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("decoding", o.decoding, Help{"options of two-return and tail decoding"}));
}

/// Error of the direct depth for one kind of light; errors are wrapped.
struct MultipathCell {
  double ratio = 0.0;
  double delay_m = 0.0;
  double law_m = 0.0;
  Estimate single_bias_m;
  Estimate single_error_m;
  Estimate bias_m, error_m;
  double cramer_rao_mae_m = 0.0;
  double two_share = 0.0;
  double unresolved_share = 0.0;

  double gain() const { return single_error_m.value / error_m.value; }
};
auto fields_of(ConstOrNot<MultipathCell> auto& c) {
  return std::tuple(
      Field("ratio", c.ratio, Help{"ratio of the second return or of the tail"}),
      Field("delay_m", c.delay_m, Help{"delay of the second return, or mean delay of the tail"}),
      Field("law_m", c.law_m,
            Help{"approximate bias of single-path decoding, ratio delay_m / (1 + ratio)"}),
      Field("single_bias_m", c.single_bias_m, FieldMark::without_error,
            InDocuments{"single_path_bias_m"}, Help{"mean error of single-path decoding (zncc)"}),
      Field("single_error_m", c.single_error_m, InDocuments{"single_path_error_m"},
            Help{"mean absolute error of single-path decoding"}),
      Field("bias_m", c.bias_m, FieldMark::without_error,
            Help{"mean error of two-return (tail) decoding; NaN if the code does not support it"}),
      Field("error_m", c.error_m, Help{"mean absolute error of two-return (tail) decoding"}),
      Field("cramer_rao_mae_m", c.cramer_rao_mae_m, Help{"bound from MultipathBound"}),
      Field("two_share", c.two_share, Help{"share of pixels with two detected returns"}),
      Field("unresolved_share", c.unresolved_share,
            Help{"share of pixels with unresolved multipath"}));
}

struct MultipathMaps {
  double signal_e_per_s = 0.0;
  MultipathCell single;               ///< without a second return
  MultipathCell single_by_tail;       ///< decoded for the middle tail
  std::vector<MultipathCell> points;  ///< by ratio, then delay
  std::vector<MultipathCell> tails;
};
auto fields_of(ConstOrNot<MultipathMaps> auto& m) {
  return std::tuple(Field("signal_e_per_s", m.signal_e_per_s),
                    Field("single", m.single, InDocuments{"single_return"}),
                    Field("single_by_tail", m.single_by_tail, InDocuments{"single_return_by_tail"}),
                    Field("points", m.points, InDocuments{"multipath"}), Field("tails", m.tails));
}

/// Errors with two returns or a tail.
struct MultipathErrorReport {
  std::string code;
  int measurements = 0;
  std::string why_no_two_returns;   ///< empty if supported
  std::string why_no_tail;          ///< empty if supported
  std::vector<MultipathMaps> maps;  ///< per signal
};

/// Computes bias and error over (delta, r) for single-path and two-return decoding, with the
/// camera's noise. Trial t of a cell uses the random stream (seed, cell, t) and a depth in the t-th
/// of `trials` slices of the range, so that all codes use the same depths and noise.
/// @throws std::invalid_argument if camera, code or options are invalid; Interrupted
/// @note same bits for any number of threads
MultipathErrorReport multipath_error(const CodeSet& code, const Camera& camera,
                                     const MultipathErrorOptions& options = {},
                                     const Progress& progress = {});

}  // namespace tofsmith

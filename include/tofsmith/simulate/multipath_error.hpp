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

/// Depth of a scene as one decoder sees it.
struct MultipathSceneDecoding {
  std::string method;    ///< "single-path", "two-return"
  Image<float> depth_m;  ///< NaN: none
  Image<float> error_m;  ///< decoded - true, the shorter way round; NaN where unknown
};

/// Pixels whose multipath light comes about as late, and how far off decoders are there.
struct DelayClass {
  double from_m = 0.0, to_m = 0.0;  ///< mean delay of the multipath light
  std::int64_t pixels = 0;
  double ratio = 0.0;           ///< mean of multipath light over direct light
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
  Image<float> multipath_ratio;    ///< multipath light over direct light; 0: none; NaN: no return
  Image<float> multipath_delay_m;  ///< mean delay of the multipath light; NaN: none
  std::vector<MultipathSceneDecoding> decodings;  ///< single-path, then two-return
  Image<ReturnStatus> returns;                    ///< of two-return decoding
  std::vector<DelayClass> classes;                ///< by mean delay; those without pixels left out
  DelayClass all;                                 ///< all pixels with multipath light
};

/// Captures and decodes. Pixels without multipath light are in no class.
/// @throws std::invalid_argument as capture(), TwoReturnDecoder and returns.validate(); Interrupted
MultipathScene multipath_scene(std::string name, const SceneImage& truth, const PinholeView& view,
                               const MultipathReturns& returns, const CodeSet& code,
                               const Camera& camera, const CaptureOptions& light,
                               const MultipathOptions& decoding = {},
                               const Progress& progress = {});

/// Which light comes back twice, and how error behind it is measured.
struct MultipathErrorOptions {
  std::vector<double> delay_m = {0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0};
  std::vector<double> ratio = {0.1, 0.3, 0.6};  ///< r = S2 / S1
  std::vector<double> tail_m = {0.25, 0.5, 1.0};
  std::vector<double> signal_e_per_s = {1e4, 1e5};  ///< S1
  double ambient_e_per_s = 1e4;                     ///< A
  std::int64_t trials = 2000;
  std::uint64_t seed = 1;
  MultipathOptions decoding;  ///< tail_m is taken from each tail's own mean delay

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};
auto fields_of(ConstOrNot<MultipathErrorOptions> auto& o) {
  return std::tuple(
      Field("delay_m", o.delay_m, above(0), Help{"delays of the second return"}),
      Field("ratio", o.ratio, closed(0, 1), Help{"ratios of the second return to the direct one"}),
      Field("tail_m", o.tail_m, above(0), Help{"mean delays of tails"}),
      Field("signal_e_per_s", o.signal_e_per_s, above(0), Help{"light of the direct return"}),
      Field("ambient_e_per_s", o.ambient_e_per_s, at_least(0), Help{"ambient light"}),
      Field("trials", o.trials, closed(2, 1e7), Help{"trials per cell of a map"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("decoding", o.decoding, Help{"options of two-return and tail decoding"}));
}

/// Error of direct depth in one kind of light: all errors the shorter way round the range.
struct MultipathCell {
  double ratio = 0.0;
  double delay_m = 0.0;           ///< of the second return, or mean delay of the tail
  double law_m = 0.0;             ///< r delta / (1 + r)
  Estimate single_bias_m;         ///< mean of decoded - true, single-path (zncc)
  Estimate single_error_m;        ///< mean of |decoded - true|
  Estimate bias_m, error_m;       ///< of two-return (tail) decoding; NaN where the code cannot
  double cramer_rao_mae_m = 0.0;  ///< MultipathBound
  double two_share = 0.0;         ///< of pixels found to hold two returns
  double unresolved_share = 0.0;

  double gain() const { return single_error_m.value / error_m.value; }
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<MultipathCell> auto& c) {
  return std::tuple(Field("ratio", c.ratio), Field("delay_m", c.delay_m), Field("law_m", c.law_m),
                    Field("single_bias_m", c.single_bias_m, FieldMark::without_error,
                          InDocuments{"single_path_bias_m"}),
                    Field("single_error_m", c.single_error_m, InDocuments{"single_path_error_m"}),
                    Field("bias_m", c.bias_m, FieldMark::without_error),
                    Field("error_m", c.error_m), Field("cramer_rao_mae_m", c.cramer_rao_mae_m),
                    Field("two_share", c.two_share), Field("unresolved_share", c.unresolved_share));
}

/// Maps at one signal.
struct MultipathMaps {
  double signal_e_per_s = 0.0;
  MultipathCell single;               ///< no second return: what two-return decoding loses
  MultipathCell single_by_tail;       ///< the same by tail decoding, of the middle tail
  std::vector<MultipathCell> points;  ///< ratio by ratio, each delay by delay
  std::vector<MultipathCell> tails;   ///< the same of tails
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<MultipathMaps> auto& m) {
  return std::tuple(Field("signal_e_per_s", m.signal_e_per_s),
                    Field("single", m.single, InDocuments{"single_return"}),
                    Field("single_by_tail", m.single_by_tail, InDocuments{"single_return_by_tail"}),
                    Field("points", m.points, InDocuments{"multipath"}), Field("tails", m.tails));
}

/// What a code does where light comes back twice.
struct MultipathErrorReport {
  std::string code;
  int measurements = 0;
  std::string why_no_two_returns;   ///< empty where two-return decoding works
  std::string why_no_tail;          ///< empty where tail decoding works
  std::vector<MultipathMaps> maps;  ///< of each signal
};

/// Bias and error over (delta, r), single-path against two-return decoding, in the camera's noise.
/// Trial t of a cell draws from the stream (seed, cell, t): its depth, uniform on the t-th of
/// `trials` slices of the range (of those that the camera says occur), then noise; all codes see
/// the same.
/// @throws std::invalid_argument if camera, code or options are invalid; Interrupted if progress
///         says so
/// @note same bits for any number of threads
MultipathErrorReport multipath_error(const CodeSet& code, const Camera& camera,
                                     const MultipathErrorOptions& options = {},
                                     const Progress& progress = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/design/candidate.hpp"

namespace tofsmith {

struct OptimizeOptions {
  int samples = 120;
  int starts = 36;
  int steps_per_start = 80;
  int hops = 24;
  int steps_per_hop = 200;
  int patience = 18;
  int refined = 6;
  int refinement_steps = 200;
  int trials_per_step = 200;
  int pool_trials = 40000;
  bool polish = true;
  int polish_steps = 250;
  std::uint64_t seed = 1;
  /// Weight of log E3 in the loss, next to weights 1 - w of log E1 and w of log E2
  /// (OperatingMultipath::weight). E3 is the error of the direct depth if pairs of returns are
  /// searched on a grid of bins.
  double two_return_weight = 0.02;
  /// Above it, judge() multiplies the error by the ratio to this limit, at most by 1.25.
  double max_two_return_loss = 3.0;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<OptimizeOptions> auto& o) {
  constexpr OnlyWith multipath{"multipath in the camera's [operating]"};
  return std::tuple(
      Field("samples", o.samples, closed(24, 960),
            Help{"cells per period while optimizing; fewer if the camera's shortest pulse is "
                 "longer than such a cell"}),
      Field("starts", o.starts, at_least(1), ByEffort{2}, Help{"descents from different codes"}),
      Field("steps_per_start", o.steps_per_start, at_least(1), Help{"gradient steps per start"}),
      Field("hops", o.hops, at_least(0), ByEffort{0},
            Help{"descents from the best codes and from changed copies of them"}),
      Field("steps_per_hop", o.steps_per_hop, at_least(1), Help{"gradient steps per hop"}),
      Field("patience", o.patience, at_least(0),
            Help{"hops without a better code after which hopping ends; 0: never"}),
      Field(
          "refined", o.refined, at_least(1),
          Help{"number of the best codes that are continued and refined; at most 1 + starts / 6"}),
      Field("refinement_steps", o.refinement_steps, at_least(0), ByEffort{50},
            Help{"gradient steps per refined code"}),
      Field("trials_per_step", o.trials_per_step, at_least(8),
            Help{"noisy measurements per gradient, over all light levels"}),
      Field(
          "pool_trials", o.pool_trials, at_least(1000),
          Help{"trials that rank codes while searching, over all light levels; finished codes are "
               "ranked by twice as many, the best two by four times as many"}),
      Field("polish", o.polish, Help{"move the switching times of the result continuously"}),
      Field("polish_steps", o.polish_steps, at_least(0), Help{"gradient steps of polish"}),
      Field("seed", o.seed, FieldMark::from_above, Help{"seed of every random choice"}),
      Field("two_return_weight", o.two_return_weight, at_least(0),
            Help{"weight of the error of two-return decoding in the search; a weight above 0 "
                 "finds codes that support two-return decoding"},
            multipath),
      Field(
          "max_two_return_loss", o.max_two_return_loss, at_least(1).or_infinity(),
          Help{"largest accepted error of two-return decoding, relative to the best baseline that "
               "supports it"},
          multipath));
}

/// Optimizes all modulations and demodulations jointly for the depth error of a camera: geometric
/// mean over its operating points, of the camera's kind.
///
/// Waveforms follow stochastic gradients of a soft decoder's error, from families, mixtures of
/// frequencies, random codes and the codes in `also`. Receivers: one tap; two buckets that share
/// all charge; more exclusive taps; a mixer. Pulses and gaps of binary waveforms are at least
/// sensor.shortest_pulse_s long.
///
/// For analog arms, the result includes the codes of a search for binary arms; from twice the
/// default effort on (with_effort()), also of a search of half the effort. More freedom or effort
/// thus loses no code. design() ends a search early if another number of exposures is clearly
/// better.
/// @param exposures  1 to 8, with at least 3 measurements (2 differences)
/// @param also  starts, if they have the same number of exposures
/// @return feasible codes named "optimized-k<exposures>" for judge(), which computes their errors:
///   the best code of every stage or, with operating multipath, all refined codes
/// @throws InvalidArgument for invalid options or camera, too few measurements, or a camera without
///   band limit and without sensor.shortest_pulse_s
/// @note bit-identical for any number of threads
/// @see docs/optimize.md
std::vector<Candidate> optimize(const Camera& camera, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// Optimizes for the worst of several variants of a camera with the same taps and readout. The
/// first is the camera itself, which must support the code.
std::vector<Candidate> optimize(std::span<const Camera> variants, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// Returns two samples of the camera, a shortest pulse that they can resolve [s].
double suggested_shortest_pulse_s(const Camera& camera);

}  // namespace tofsmith

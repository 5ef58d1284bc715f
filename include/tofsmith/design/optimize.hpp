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

/// Options of the direct optimization of codes for depth error.
struct OptimizeOptions {
  int samples = 120;
  int starts = 20;
  int steps_per_start = 300;
  int hops = 40;
  int steps_per_hop = 300;
  int patience = 30;
  int refined = 1;
  int refinement_steps = 1000;
  int trials_per_step = 200;
  int pool_trials = 20000;
  bool polish = true;
  int polish_steps = 250;
  std::uint64_t seed = 1;
  /// Weight of log E3 in the loss, next to log E1^(1 - w) E2^w of OperatingMultipath::weight, where
  /// E3 is the error of the direct depth if pairs of returns are searched on the bins of a grid. It
  /// keeps pairs from looking like others.
  double two_return_weight = 0.02;
  /// Above it, the judge multiplies the error by the ratio to this limit, at most by 1.25.
  double max_two_return_loss = 3.0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<OptimizeOptions> auto& o) {
  constexpr OnlyWith multipath{"multipath of the camera's operating points"};
  return std::tuple(
      Field("samples", o.samples, closed(24, 960),
            Help{"cells per period while optimizing; fewer if the camera's shortest pulse is "
                 "longer than such a cell"}),
      Field("starts", o.starts, at_least(1), ByEffort{2}, Help{"descents from different codes"}),
      Field("steps_per_start", o.steps_per_start, at_least(1), Help{"gradient steps per start"}),
      Field("hops", o.hops, at_least(0), ByEffort{0},
            Help{"descents from changed copies of the best codes"}),
      Field("steps_per_hop", o.steps_per_hop, at_least(1), Help{"gradient steps per hop"}),
      Field("patience", o.patience, at_least(0),
            Help{"hops without a better code after which hopping ends; 0: never"}),
      Field("refined", o.refined, at_least(1), Help{"how many of the best codes are refined"}),
      Field("refinement_steps", o.refinement_steps, at_least(0), ByEffort{50},
            Help{"gradient steps per refined code"}),
      Field("trials_per_step", o.trials_per_step, at_least(8),
            Help{"noisy measurements per gradient, over all light levels"}),
      Field("pool_trials", o.pool_trials, at_least(1000),
            Help{"trials that rank codes while searching, over all light levels"}),
      Field("polish", o.polish, Help{"move the switching times of the result continuously"}),
      Field("polish_steps", o.polish_steps, at_least(0), Help{"steps of that"}),
      Field("seed", o.seed, FieldMark::from_above, Help{"seed of every random choice"}),
      Field("two_return_weight", o.two_return_weight, at_least(0),
            Help{"weight of the error decoded as two returns in the search, so that codes can be "
                 "decoded so; 0: none"},
            multipath),
      Field("max_two_return_loss", o.max_two_return_loss, at_least(1).or_infinity(),
            Help{"error of two-return decoding that a code may have, relative to the best "
                 "baseline that can be decoded so"},
            multipath));
}

/// Optimizes all pairs of modulation and demodulation together for the depth error of a camera:
/// geometric mean over its operating points, linear or circular as the camera asks.
///
/// Waveforms go downhill along stochastic gradients through band limit, correlation, noise and a
/// soft decoder, from a pool of starts (all families, random codes and the codes given);
/// the best are changed and go downhill again; the best of all are refined, made to switch where
/// arms are binary, and their edges polished. Light may use less than its peak. Taps: one; two
/// buckets that share all charge; more, exclusive, with a drain where the camera has one; a mixer.
/// Every pulse and gap of binary waveforms is at least sensor.shortest_pulse_s long.
///
/// Where an arm need not switch the whole search is made for arms that do, too, and then begins
/// with what it found. From twice the default effort on (with_effort()) a search begins with all of
/// that of half the effort. Candidates of both join: what contains more never loses by it.
/// @param exposures  1 .. 8, with at least 3 measurements in all (2 differences)
/// @param also  codes that join the starts, where they have as many exposures
/// @return codes that the camera can play, each named "optimized-k<exposures>", those first that
/// the
///         search likes better: the best of the pool with switching times on the grid, then with
///         polished edges; those of arms that switch and of less effort before. They are not
///         judged: Candidate::error is empty, and which one is best, at which origin, and whether
///         it beats the codes given, is for judge() of design/design.hpp, with random numbers that
///         nothing was chosen by. design() does both.
/// @throws std::invalid_argument for bad options, an invalid camera, too few measurements, a camera
///         without band limit and without sensor.shortest_pulse_s; Interrupted
/// @note same bits for any number of threads
std::vector<Candidate> optimize(const Camera& camera, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// The same for the worst of several variants of a camera, the first of which is the camera itself:
/// the code must be one that it can play. Taps and readout of all must be the same.
std::vector<Candidate> optimize(std::span<const Camera> variants, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// A shortest pulse that the camera's samples can follow [s]: two of them.
double suggested_shortest_pulse_s(const Camera& camera);

}  // namespace tofsmith

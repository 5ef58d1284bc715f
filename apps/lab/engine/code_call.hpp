// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reply.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith::lab {

/// What a camera makes of a code: its waveforms, correlation functions and coding curve.
///   light, gates (tap values, N): actual waveforms, ahead of the arms' impulse responses;
///   light_behind, gates_behind: behind them, where there are any;
///   correlation (K, N); curve (N, 3), with the share of its variance that three directions keep;
///   light_edges, gate_edges: for each tap value [rise, fall, rise, ..] in periods, of the nominal
///   waveforms; empty where one has other than two levels.
Answer code_answer(const CodeSet& code, const Camera& camera);

/// Which edge of which waveform.
struct EdgePlace {
  bool is_light = true;
  int measurement = 0;   ///< tap value; a light is that of all taps of its exposure
  std::size_t edge = 0;  ///< index into its light_edges or gate_edges
};

/// The code with one switching time moved; it stops where it would pass its neighbour. The light
/// then is as bright as its average and peak power let it. The second of two taps that was the
/// complement of the first, or the first of the second, stays it.
/// @param position  [periods], any finite number
/// @throws InvalidArgument for a place that is not there, a waveform that has other than two
///         levels, or a code that the camera cannot play
CodeSet with_edge_moved(const CodeSet& code, const Camera& camera, const EdgePlace& place,
                        double position);

}  // namespace tofsmith::lab

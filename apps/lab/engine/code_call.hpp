// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "answer.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith::lab {

/// Returns {toml, fields, range_m}: the complete camera, and every key that applies to it.
Answer camera_answer(const Camera& camera);

/// Returns the waveforms, correlation functions and coding curve of a code on a camera.
///   - light, gates (tap values, N): actual waveforms before the impulse responses;
///   - light_behind, gates_behind: the same after the impulse responses, if there are any;
///   - correlation (K, N); curve (N, 3), with the share of the variance in three directions;
///   - light_edges, gate_edges: for each tap value [rise, fall, rise, ...] in periods, of the
///     nominal waveforms; empty for waveforms that are not binary.
Answer code_answer(const CodeSet& code, const Camera& camera);

enum class EdgeArm { light, gate };
constexpr auto words_of(EdgeArm /*any*/) { return word_list("light", "gate"); }

/// All members are required.
struct EdgeMove {
  std::optional<EdgeArm> arm;
  std::optional<int> measurement, edge;
  std::optional<double> position;
};
auto fields_of(ConstOrNot<EdgeMove> auto& m) {
  return std::tuple(
      Field("arm", m.arm, Help{"arm of the waveform; light applies to all taps of its exposure"}),
      Field("measurement", m.measurement, at_least(0), Help{"tap value"}),
      Field("edge", m.edge, at_least(0), Help{"index into its light_edges or gate_edges"}),
      Field("position", m.position, finite(), Help{"new position in periods"}));
}

/// Returns the code with one switching time moved, at most to the neighbouring edge. The light
/// keeps the maximum brightness that its average and peak power permit. Complementary taps remain
/// complementary.
/// @throws InvalidArgument for a missing member, an invalid place, a waveform that is not binary,
///   or a code that the camera does not support
CodeSet with_edge_moved(const CodeSet& code, const Camera& camera, const EdgeMove& move);

}  // namespace tofsmith::lab

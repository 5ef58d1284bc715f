// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "decode/search/direction_table.hpp"
#include "decode_setup.hpp"
#include "generated_curves.hpp"

namespace tofsmith {

/// The directions of any curve.
inline DirectionTable directions_of(const Curve& curve) {
  DecodingTable table;
  table.correlation = curve;
  table.ambient_gain = Eigen::VectorXd::Zero(curve.cols());
  table.exposure_s = Eigen::VectorXd::Ones(curve.cols());
  return DirectionTable(AmbientProjection(table));
}

/// The curve of a code of this many bins, without what ambient light explains.
inline DirectionTable directions_of(const std::string& code, int code_samples, int samples) {
  Camera camera = camera_with("paper-10f0");
  camera.samples = code_samples;
  const CodeSet set = build_family(code, camera).resampled(samples);
  camera.samples = samples;
  return DirectionTable(AmbientProjection(make_decoding_table(ForwardModel(set, camera), camera)));
}

}  // namespace tofsmith

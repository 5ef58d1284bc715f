// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "decode/search/direction_table.hpp"
#include "decode_setup.hpp"
#include "generated_curves.hpp"

namespace tofsmith {

inline DirectionTable directions_of(const Curve& curve) {
  DecodingTable table;
  table.correlation = curve;
  table.ambient_gain = Eigen::VectorXd::Zero(curve.cols());
  table.exposure_s = Eigen::VectorXd::Ones(curve.cols());
  return DirectionTable(AmbientProjection(table));
}

/// The code has `code_samples` bins; ambient light is projected out.
inline DirectionTable directions_of(const std::string& code, int code_samples, int samples) {
  Camera camera = camera_with("paper-10f0");
  camera.samples = code_samples;
  const CodeSet set = build_family(code, camera).resampled(samples);
  camera.samples = samples;
  return DirectionTable(AmbientProjection(make_decoding_table(ForwardModel(set, camera), camera)));
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_estimator.hpp"

#include <memory>

#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

DepthEstimator correlation_estimator(const ForwardModel& model, const Camera& camera) {
  const auto decoder = std::make_shared<const Decoder>(make_decoding_table(model, camera));
  return [decoder](const float* measurements, std::int64_t pixels, double* depth_bin) {
    decoder->decode_depth_bins(measurements, pixels, depth_bin);
  };
}

}  // namespace tofsmith

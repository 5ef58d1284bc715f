// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decode_method.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "decode/output/pixel_output.hpp"

namespace tofsmith {

DepthImage DepthDecoder::decode(const RawFrames& raw, int frame, const Progress& progress) const {
  const RawView view = view_of_frame(raw, frame);
  DepthImage image(usual_planes(finds_returns()), raw.height, raw.width);
  decode(view, DecodedView::of(image), progress);
  return image;
}

void DepthDecoder::decode_bins(const float* measurements, std::int64_t pixels,
                               std::int32_t* bin) const {
  constexpr std::int64_t block = 512;
  double position[block];
  for (std::int64_t done = 0; done < pixels; done += block) {
    const std::int64_t count = std::min(pixels - done, block);
    decode_depth_bins(measurements + done * this->measurements(), count, position);
    for (std::int64_t i = 0; i < count; ++i)
      bin[done + i] = std::isnan(position[i]) ? -1 : nearest_bin(position[i], samples());
  }
}

std::unique_ptr<const DepthDecoder> make_decoder(DecodeMethod method, DecodingTable table,
                                                 const DecodeOptions& status_thresholds,
                                                 UnwrapWeights unwrap_weights,
                                                 const MultipathOptions& multipath) {
  MultipathOptions of_returns = multipath;
  of_returns.status_thresholds = status_thresholds;
  switch (method) {
    case DecodeMethod::zncc:
      return std::make_unique<const Decoder>(std::move(table), status_thresholds);
    case DecodeMethod::ml:
      return std::make_unique<const LikelihoodDecoder>(std::move(table), status_thresholds);
    case DecodeMethod::two_return:
      return std::make_unique<const TwoReturnDecoder>(std::move(table), of_returns);
    case DecodeMethod::tail:
      return std::make_unique<const TailDecoder>(std::move(table), of_returns);
    case DecodeMethod::unwrap:
      break;
  }
  return std::make_unique<const UnwrapDecoder>(
      std::move(table),
      UnwrapOptions{.status_thresholds = status_thresholds, .weights = unwrap_weights});
}

}  // namespace tofsmith

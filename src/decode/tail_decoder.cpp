// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/tail_decoder.hpp"

#include "decode/multipath_engine.hpp"
#include "decode/nearest_bins.hpp"
#include "decode/pixel_output.hpp"

namespace tofsmith {

struct TailDecoder::Plan {
  MultipathEngine engine;
};

TailDecoder::TailDecoder(DecodingTable table, const MultipathOptions& options)
    : plan_(std::make_unique<const Plan>(
          Plan{MultipathEngine(std::move(table), options, LaterLight::tail)})) {}
TailDecoder::~TailDecoder() = default;
TailDecoder::TailDecoder(TailDecoder&&) noexcept = default;
TailDecoder& TailDecoder::operator=(TailDecoder&&) noexcept = default;

const DecodingTable& TailDecoder::table() const { return plan_->engine.table(); }
const MultipathOptions& TailDecoder::options() const { return plan_->engine.options(); }

void TailDecoder::decode(const RawView& raw, const DecodedView& decoded,
                         const Progress& progress) const {
  plan_->engine.decode(raw, decoded, progress);
}

MultipathImage TailDecoder::decode(const RawFrames& raw, int frame,
                                   const Progress& progress) const {
  const RawView view = view_of_frame(raw, frame);
  MultipathImage image(raw.height, raw.width);
  decode(view, image.view(), progress);
  return image;
}

void TailDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                    double* depth_bin) const {
  plan_->engine.decode_depth_bins(measurements, pixels, depth_bin);
}

void TailDecoder::decode_bins(const float* measurements, std::int64_t pixels,
                              std::int32_t* bin) const {
  nearest_bins(*this, measurements, pixels, bin);
}

}  // namespace tofsmith

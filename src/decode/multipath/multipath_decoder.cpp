// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/multipath_decoder.hpp"

#include "decode/multipath/multipath_engine.hpp"
#include "decode/multipath/multipath_support.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/search/nearest_bins.hpp"

namespace tofsmith {

struct MultipathDecoder::Plan {
  MultipathEngine engine;
};

MultipathDecoder::MultipathDecoder(std::unique_ptr<const Plan> plan) : plan_(std::move(plan)) {}
MultipathDecoder::~MultipathDecoder() = default;
MultipathDecoder::MultipathDecoder(MultipathDecoder&&) noexcept = default;
MultipathDecoder& MultipathDecoder::operator=(MultipathDecoder&&) noexcept = default;

TwoReturnDecoder::TwoReturnDecoder(DecodingTable table, const MultipathOptions& options)
    : MultipathDecoder(std::make_unique<const Plan>(
          Plan{MultipathEngine(std::move(table), options, LaterLight::second_return)})) {}

TailDecoder::TailDecoder(DecodingTable table, const MultipathOptions& options)
    : MultipathDecoder(std::make_unique<const Plan>(
          Plan{MultipathEngine(std::move(table), options, LaterLight::tail)})) {}

namespace {

std::optional<std::string> why_not(const DecodingTable& table, LaterLight later) {
  if (auto no_depth = why_not_decodable(table)) return no_depth;
  return text_of(missing_support(AmbientProjection(table), later));
}

}  // namespace

std::optional<std::string> TwoReturnDecoder::why_not_decodable(const DecodingTable& table) {
  return why_not(table, LaterLight::second_return);
}

std::optional<std::string> TailDecoder::why_not_decodable(const DecodingTable& table) {
  return why_not(table, LaterLight::tail);
}

const DecodingTable& MultipathDecoder::table() const { return plan_->engine.table(); }
const MultipathOptions& MultipathDecoder::options() const { return plan_->engine.options(); }

void MultipathDecoder::decode(const RawView& raw, const DecodedView& decoded,
                              const Progress& progress) const {
  plan_->engine.decode(raw, decoded, progress);
}

MultipathImage MultipathDecoder::decode(const RawFrames& raw, int frame,
                                        const Progress& progress) const {
  const RawView view = view_of_frame(raw, frame);
  MultipathImage image(raw.height, raw.width);
  decode(view, image.view(), progress);
  return image;
}

void MultipathDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                         double* depth_bin) const {
  plan_->engine.decode_depth_bins(measurements, pixels, depth_bin);
}

void MultipathDecoder::decode_bins(const float* measurements, std::int64_t pixels,
                                   std::int32_t* bin) const {
  nearest_bins(*this, measurements, pixels, bin);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decode_method.hpp"

#include <type_traits>
#include <utility>

namespace tofsmith {

namespace {

template <typename MethodDecoder>
class DecoderOf final : public DepthDecoder {
 public:
  DecoderOf(DecodeMethod method, MethodDecoder decoder)
      : method_(method), decoder_(std::move(decoder)) {}

  DecodeMethod method() const override { return method_; }
  const DecodingTable& table() const override { return decoder_.table(); }
  void decode(const RawView& raw, const DecodedView& decoded,
              const Progress& progress) const override {
    decoder_.decode(raw, decoded, progress);
  }
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress) const override {
    decoder_.decode_within(raw, parts, decoded, progress);
  }
  void decode_depth_bins(const float* measurements, std::int64_t pixels,
                         double* depth_bin) const override {
    decoder_.decode_depth_bins(measurements, pixels, depth_bin);
  }
  void decode_bins(const float* measurements, std::int64_t pixels,
                   std::int32_t* bin) const override {
    decoder_.decode_bins(measurements, pixels, bin);
  }
  const Decoder* correlation_decoder() const override {
    if constexpr (std::is_same_v<MethodDecoder, Decoder>) return &decoder_;
    return nullptr;
  }

 private:
  DecodeMethod method_;
  MethodDecoder decoder_;
};

}  // namespace

std::unique_ptr<const DepthDecoder> make_decoder(DecodeMethod method, DecodingTable table,
                                                 const DecodeOptions& status_thresholds,
                                                 UnwrapWeights unwrap_weights,
                                                 const MultipathOptions& multipath) {
  const auto decoder_of = [&]<typename MethodDecoder>(MethodDecoder decoder) {
    return std::make_unique<DecoderOf<MethodDecoder>>(method, std::move(decoder));
  };
  MultipathOptions of_returns = multipath;
  of_returns.status_thresholds = status_thresholds;
  switch (method) {
    case DecodeMethod::zncc:
      return decoder_of(Decoder(std::move(table), status_thresholds));
    case DecodeMethod::ml:
      return decoder_of(LikelihoodDecoder(std::move(table), status_thresholds));
    case DecodeMethod::two_return:
      return decoder_of(TwoReturnDecoder(std::move(table), of_returns));
    case DecodeMethod::tail:
      return decoder_of(TailDecoder(std::move(table), of_returns));
    case DecodeMethod::unwrap:
      break;
  }
  return decoder_of(UnwrapDecoder(
      std::move(table), {.status_thresholds = status_thresholds, .weights = unwrap_weights}));
}

}  // namespace tofsmith

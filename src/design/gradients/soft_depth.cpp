// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "design/gradients/gradient_steps.hpp"
#include "design/optimize/soft_decoder.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

template <typename Value>
class PixelDecoder {
 public:
  PixelDecoder(const DecodingCurveOf<Value>& curve, std::span<const Value> electrons,
               const SoftDecoding& decoding, std::span<const double> true_bin)
      : curve_(&curve),
        electrons_(electrons),
        decoding_(&decoding),
        true_bin_(true_bin),
        decoder_(curve) {}

  double answer(std::size_t pixel) {
    const SoftQuestion question = question_of(pixel);
    const double answer = decoder_.expected_error(*curve_, electrons_of(pixel), question);
    return true_bin_.empty() ? wrapped(question.true_bin + answer) : answer;
  }

  void pull_back(std::size_t pixel, double weight, CurveGradientOf<Value>& gradient,
                 Value* by_electrons) {
    const auto by_answer = static_cast<Value>(weight);
    decoder_.expected_error(*curve_, electrons_of(pixel), question_of(pixel), by_answer, gradient,
                            by_electrons);
    for (int r = 0; r < curve_->measurements; ++r) by_electrons[r] *= by_answer;
  }

 private:
  const Value* electrons_of(std::size_t pixel) const {
    return electrons_.data() + pixel * static_cast<std::size_t>(curve_->measurements);
  }
  /// Depth is the error relative to bin 0, circular depth relative to the best match, where
  /// relevant chords rarely wrap.
  SoftQuestion question_of(std::size_t pixel) {
    SoftQuestion question{0.0, 1.0 / decoding_->temperature_e2[pixel], decoding_->circular,
                          true_bin_.empty()};
    if (!true_bin_.empty())
      question.true_bin = true_bin_[pixel];
    else if (decoding_->circular)
      question.true_bin = decoder_.decode(*curve_, electrons_of(pixel));
    return question;
  }
  double wrapped(double bin) const {
    return decoding_->circular ? wrap(bin, static_cast<double>(curve_->samples)) : bin;
  }

  const DecodingCurveOf<Value>* curve_;
  std::span<const Value> electrons_;
  const SoftDecoding* decoding_;
  std::span<const double> true_bin_;
  SoftDecoderOf<Value> decoder_;
};

template <typename Value>
std::vector<double> answers_of(const DecodingCurveOf<Value>& curve,
                               std::span<const Value> electrons, const SoftDecoding& decoding,
                               std::span<const double> true_bin) {
  const std::size_t pixels = electrons.size() / static_cast<std::size_t>(curve.measurements);
  std::vector<double> answers(pixels);
  const auto count = static_cast<std::int64_t>(pixels);
  parallel_for_blocks(count, pixels_in_a_group(count), [&](IndexRange range) {
    PixelDecoder<Value> decoder(curve, electrons, decoding, true_bin);
    for (auto p = static_cast<std::size_t>(range.begin); p < static_cast<std::size_t>(range.end);
         ++p)
      answers[p] = decoder.answer(p);
  });
  return answers;
}

void add_table(MeasurementTable& sum, const MeasurementTable& part) {
  sum.correlation += part.correlation;
  sum.ambient_gain += part.ambient_gain;
}

}  // namespace

template <typename Value>
std::vector<double> CodeGradients::soft_decode(const MeasurementTable& table,
                                               std::span<const Value> electrons,
                                               const SoftDecoding& decoding) const {
  return answers_of(DecodingCurveOf<Value>(steps_->sampled, table), electrons, decoding, {});
}

template <typename Value>
std::vector<double> CodeGradients::soft_error(const MeasurementTable& table,
                                              std::span<const Value> electrons,
                                              const SoftDecoding& decoding,
                                              std::span<const double> true_bin) const {
  return answers_of(DecodingCurveOf<Value>(steps_->sampled, table), electrons, decoding, true_bin);
}

template <typename Value>
DecodedGradient<Value> CodeGradients::pull_back_decoded(const MeasurementTable& table,
                                                        std::span<const Value> electrons,
                                                        const SoftDecoding& decoding,
                                                        std::span<const double> true_bin,
                                                        std::span<const double> weight) const {
  const DecodingCurveOf<Value> curve(steps_->sampled, table);
  const auto K = static_cast<std::size_t>(curve.measurements);
  DecodedGradient<Value> gradient{zeros_like(table), std::vector<Value>(electrons.size())};
  const auto pixels = static_cast<std::int64_t>(weight.size());
  const std::int64_t in_a_group = pixels_in_a_group(pixels);
  std::vector<MeasurementTable> parts(
      static_cast<std::size_t>((pixels + in_a_group - 1) / in_a_group), zeros_like(table));
  parallel_for_blocks(pixels, in_a_group, [&](IndexRange range) {
    PixelDecoder<Value> decoder(curve, electrons, decoding, true_bin);
    CurveGradientOf<Value> by_curve(curve);
    for (auto p = static_cast<std::size_t>(range.begin); p < static_cast<std::size_t>(range.end);
         ++p)
      decoder.pull_back(p, weight[p], by_curve, gradient.electrons.data() + p * K);
    by_curve.pull_back(steps_->sampled, table, curve,
                       parts[static_cast<std::size_t>(range.begin / in_a_group)]);
  });
  for (const MeasurementTable& part : parts) add_table(gradient.table, part);
  return gradient;
}

#define TOFSMITH_INSTANTIATE(Value)                                                \
  template std::vector<double> CodeGradients::soft_decode(                         \
      const MeasurementTable&, std::span<const Value>, const SoftDecoding&) const; \
  template std::vector<double> CodeGradients::soft_error(                          \
      const MeasurementTable&, std::span<const Value>, const SoftDecoding&,        \
      std::span<const double>) const;                                              \
  template DecodedGradient<Value> CodeGradients::pull_back_decoded(                \
      const MeasurementTable&, std::span<const Value>, const SoftDecoding&,        \
      std::span<const double>, std::span<const double>) const

TOFSMITH_INSTANTIATE(float);
TOFSMITH_INSTANTIATE(double);
#undef TOFSMITH_INSTANTIATE

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "camera/shared/ambient_leak.hpp"
#include "design/gradients/between_bins.hpp"
#include "design/gradients/depth_elimination.hpp"
#include "design/optimize/soft_decoder.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

struct CodeGradients::Steps {
  Steps(const Camera& its, int samples, int exposures);

  bool has_shot() const { return sampled.subtracts(); }
  /// Functions of all measurements (K), then of their total light for differences (2 K).
  BetweenBins::Functions functions_of(const MeasurementTable& table) const;
  void pull_back_functions(const BetweenBins::Functions& gradient,
                           MeasurementTable& by_table) const;

  Camera camera;
  SampledCamera sampled;
  BetweenBins between;
  int exposures;
};

namespace {

/// At most 64 groups of whole blocks, for any number of threads.
std::int64_t pixels_in_a_group(std::int64_t pixels) {
  constexpr std::int64_t groups = 64;
  const std::int64_t even = (pixels + groups - 1) / groups;
  return std::max<std::int64_t>(1, (even + harmonic_block - 1) / harmonic_block) * harmonic_block;
}

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
    decoder_.expected_error(*curve_, electrons_of(pixel), question_of(pixel), by_answer, &gradient,
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
  for (const MeasurementTable& part : parts) {
    gradient.table.correlation += part.correlation;
    gradient.table.ambient_gain += part.ambient_gain;
  }
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

namespace {

void round_up(Eigen::MatrixXd& table) {
  const Eigen::Index depths = table.rows();
  const Eigen::Index rows = (depths + depth_block - 1) / depth_block * depth_block;
  if (rows == depths) return;
  table.conservativeResize(rows, Eigen::NoChange);
  table.bottomRows(rows - depths).setZero();
}

DepthElectrons electrons_of(const CodeGradients::Steps& steps, const MeasurementTable& table) {
  const Eigen::MatrixXd fine =
      steps.between.fine_table(steps.functions_of(table), 2 * cells_per_bin);
  const Eigen::VectorXd& time_s = steps.sampled.exposure_s();
  const Eigen::Index K = time_s.size();
  DepthElectrons electrons;
  middles_and_slopes(fine.leftCols(K) * time_s.asDiagonal(), electrons.signal, electrons.slope);
  electrons.shot = electrons.signal;
  if (steps.has_shot()) {
    Eigen::MatrixXd unused;
    middles_and_slopes(fine.rightCols(K) * time_s.asDiagonal(), electrons.shot, unused);
  }
  electrons.shot_ambient = time_s.cwiseProduct(table.shot_ambient());
  electrons.ambient = time_s.cwiseProduct(table.ambient_gain);
  const double brightest = brightest_ambient_e_per_s(steps.camera);
  if (ambient_cancels(steps.camera, brightest * electrons.ambient,
                      steps.sampled.constant_variance_e2() + brightest * electrons.shot_ambient))
    electrons.ambient.setZero();
  electrons.ambient = (electrons.ambient.array().abs() > 1e-9 * electrons.shot_ambient.array())
                          .select(electrons.ambient, 0.0);
  for (Eigen::MatrixXd* of : {&electrons.signal, &electrons.slope, &electrons.shot}) round_up(*of);
  return electrons;
}

}  // namespace

Eigen::MatrixXd CodeGradients::depth_deviation_m(const MeasurementTable& table,
                                                 std::span<const OperatingPoint> points) const {
  Eigen::MatrixXd deviation_m;
  eliminate_light(electrons_of(*steps_, table), steps_->sampled.constant_variance_e2(), points,
                  steps_->camera.range_m(), deviation_m);
  const Eigen::Index depths = cells_per_bin * table.samples();
  if (deviation_m.rows() > depths) deviation_m.conservativeResize(depths, Eigen::NoChange);
  return deviation_m;
}

PixelGradient CodeGradients::pull_back_depth_deviation(const MeasurementTable& table,
                                                       std::span<const OperatingPoint> points,
                                                       const Eigen::MatrixXd& by_deviation) const {
  const DepthElectrons electrons = electrons_of(*steps_, table);
  const Eigen::Index K = electrons.signal.cols(), depths = cells_per_bin * table.samples();
  const auto lights = static_cast<Eigen::Index>(points.size());
  PixelGradient gradient{
      zeros_like(table), {}, Eigen::VectorXd::Zero(lights), Eigen::VectorXd::Zero(lights)};
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(electrons.signal.rows(), K);
  DepthElectrons by{none, none, none, Eigen::VectorXd::Zero(K), Eigen::VectorXd::Zero(K)};
  Eigen::MatrixXd weights = by_deviation;
  round_up(weights);
  std::vector<OperatingPoint> by_points(points.size());
  pull_back_elimination(electrons, steps_->sampled.constant_variance_e2(), points,
                        steps_->camera.range_m(), weights, by, by_points);
  for (Eigen::Index l = 0; l < lights; ++l) {
    gradient.signal_e_per_s[l] = by_points[static_cast<std::size_t>(l)].signal_e_per_s;
    gradient.ambient_e_per_s[l] = by_points[static_cast<std::size_t>(l)].ambient_e_per_s;
  }
  for (Eigen::MatrixXd* of : {&by.signal, &by.slope, &by.shot})
    of->conservativeResize(depths, Eigen::NoChange);
  const Eigen::VectorXd& time_s = steps_->sampled.exposure_s();
  if (!steps_->has_shot()) by.signal += by.shot;
  Eigen::MatrixXd by_fine = pull_back_middles_and_slopes(by.signal, by.slope) * time_s.asDiagonal();
  if (steps_->has_shot()) {
    by_fine.conservativeResize(Eigen::NoChange, 2 * K);
    by.slope.setZero();
    by_fine.rightCols(K) = pull_back_middles_and_slopes(by.shot, by.slope) * time_s.asDiagonal();
  }
  steps_->pull_back_functions(steps_->between.pull_back_fine(by_fine, 2 * cells_per_bin),
                              gradient.table);
  gradient.table.ambient_gain +=
      time_s.cwiseProduct((electrons.ambient.array() != 0.0).select(by.ambient, 0.0));
  (steps_->has_shot() ? gradient.table.shot_ambient_gain : gradient.table.ambient_gain) +=
      time_s.cwiseProduct(by.shot_ambient);
  return gradient;
}

namespace {

const Camera& without_what_has_no_gradient(const Camera& camera, int samples, int exposures) {
  camera.validate();
  require(samples >= 8 && samples <= 65536, "samples", samples, "must be in [8, 65536]");
  require(exposures >= 1 && exposures <= 1024, "exposures", exposures, "must be in [1, 1024]");
  const std::size_t listed = camera.exposure_s.each_s.size();
  require(listed == 0 || listed == static_cast<std::size_t>(exposures), "exposures", exposures,
          "must equal the number of exposure_s of the camera");
  const char* const needs = "must be omitted to compute gradients";
  require(camera.sensor.readout != Readout::rows, "sensor.readout", "rows",
          "must be separate or difference to compute gradients");
  require(!camera.sensor.is_signed(), "sensor.demodulation", "signed",
          "must be \"gain\" to compute gradients; the difference of two buckets is equivalent to a "
          "switching mixer");
  require(!camera.light.generator, "light.generator", "set", needs);
  require(!camera.sensor.generator, "sensor.generator", "set", needs);
  require(!camera.playback, "playback", "set", needs);
  require(!camera.temperature, "temperature", "set", needs);
  require(camera.sensor.tap_mismatch == 0.0, "sensor.tap_mismatch", camera.sensor.tap_mismatch,
          "must be 0 to compute gradients");
  return camera;
}

template <typename Store>
void evaluate_blocks(const BetweenBins& between, const BetweenBins::Functions& functions,
                     std::span<const double> depth_bin, IndexRange range, bool with_slopes,
                     const Store& store) {
  const std::size_t size = static_cast<std::size_t>(functions.count()) * harmonic_block;
  std::vector<double> values(size), slopes(with_slopes ? size : 0);
  for (std::int64_t first = range.begin; first < range.end; first += harmonic_block) {
    const auto count = std::min<std::int64_t>(harmonic_block, range.end - first);
    between.evaluate(
        functions,
        depth_bin.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)),
        values.data(), with_slopes ? slopes.data() : nullptr);
    store(first, count, values.data(), slopes.data());
  }
}

}  // namespace

CodeGradients::Steps::Steps(const Camera& its, int samples, int exposures)
    : camera(without_what_has_no_gradient(its, samples, exposures)),
      sampled(camera, samples, exposures),
      between(camera, samples),
      exposures(exposures) {}

BetweenBins::Functions CodeGradients::Steps::functions_of(const MeasurementTable& table) const {
  if (!has_shot()) return between.of(table.correlation);
  Eigen::MatrixXd both(table.samples(), 2 * table.measurements());
  both << table.correlation, table.shot_correlation;
  return between.of(both);
}

void CodeGradients::Steps::pull_back_functions(const BetweenBins::Functions& gradient,
                                               MeasurementTable& by_table) const {
  const Eigen::MatrixXd both = between.pull_back(gradient);
  const Eigen::Index K = by_table.correlation.cols();
  by_table.correlation += both.leftCols(K);
  if (has_shot()) by_table.shot_correlation += both.rightCols(K);
}

CodeGradients::CodeGradients(const Camera& camera, int samples, int exposures)
    : steps_(make_hidden<const Steps>(camera, samples, exposures)) {}

int CodeGradients::samples() const { return steps_->sampled.samples(); }
int CodeGradients::exposures() const { return steps_->exposures; }
int CodeGradients::tap_values() const { return steps_->exposures * steps_->camera.sensor.taps; }
int CodeGradients::measurements() const { return steps_->sampled.measurements(); }
bool CodeGradients::has_shot() const { return steps_->has_shot(); }
const Eigen::VectorXd& CodeGradients::dark_electrons() const {
  return steps_->sampled.dark_electrons();
}

MeasurementTable CodeGradients::measure(const Eigen::MatrixXd& modulation,
                                        const Eigen::MatrixXd& demodulation) const {
  return steps_->sampled.measure({modulation, demodulation}).table;
}

std::pair<Eigen::MatrixXd, Eigen::MatrixXd> CodeGradients::pull_back(
    const Eigen::MatrixXd& modulation, const Eigen::MatrixXd& demodulation,
    const MeasurementTable& by_table) const {
  const SampledCamera::Measured measured = steps_->sampled.transformed({modulation, demodulation});
  SampledCode by_code = steps_->sampled.pull_back(measured, by_table);
  return {std::move(by_code.modulation), std::move(by_code.demodulation)};
}

void CodeGradients::electrons(const MeasurementTable& table, const PixelLight& light, Rows& mean,
                              Rows& variance) const {
  const int K = measurements();
  const auto pixels = static_cast<std::int64_t>(light.depth_bin.size());
  const BetweenBins::Functions functions = steps_->functions_of(table);
  const Eigen::VectorXd& time_s = steps_->sampled.exposure_s();
  const Eigen::VectorXd& dark_e = steps_->sampled.dark_electrons();
  const Eigen::VectorXd& constant_e2 = steps_->sampled.constant_variance_e2();
  const Eigen::VectorXd &kappa = table.ambient_gain, &shot_kappa = table.shot_ambient();
  const int shot = has_shot() ? K * harmonic_block : 0;
  mean.resize(pixels, K);
  variance.resize(pixels, K);
  const auto store = [&](std::int64_t first, std::int64_t count, const double* values,
                         const double*) {
    for (std::int64_t p = 0; p < count; ++p) {
      const auto pixel = static_cast<std::size_t>(first + p);
      const double signal = light.signal_e_per_s[pixel], ambient = light.ambient_e_per_s[pixel];
      for (int i = 0; i < K; ++i) {
        const double* const chi = values + i * harmonic_block + p;
        mean(first + p, i) = time_s[i] * (signal * *chi + ambient * kappa[i]) + dark_e[i];
        variance(first + p, i) =
            time_s[i] * (signal * chi[shot] + ambient * shot_kappa[i]) + constant_e2[i];
      }
    }
  };
  parallel_for_blocks(pixels, pixels_in_a_group(pixels), [&](IndexRange range) {
    evaluate_blocks(steps_->between, functions, light.depth_bin, range, false, store);
  });
}

PixelGradient CodeGradients::pull_back_electrons(const MeasurementTable& table,
                                                 const PixelLight& light, const Rows& by_mean,
                                                 const Rows& by_variance,
                                                 WantedGradients wanted) const {
  const int K = measurements();
  const auto pixels = static_cast<std::int64_t>(light.depth_bin.size());
  const BetweenBins::Functions functions = steps_->functions_of(table);
  const Eigen::VectorXd& time_s = steps_->sampled.exposure_s();
  const bool apart = has_shot();
  PixelGradient gradient{zeros_like(table), Eigen::VectorXd::Zero(pixels),
                         Eigen::VectorXd::Zero(pixels), Eigen::VectorXd::Zero(pixels)};

  struct Part {
    BetweenBins::Functions functions;
    Eigen::VectorXd by_ambient, by_shot_ambient;
  };
  const std::int64_t in_a_group = pixels_in_a_group(pixels);
  std::vector<Part> parts(static_cast<std::size_t>((pixels + in_a_group - 1) / in_a_group),
                          Part{steps_->between.zeros(wanted.table ? functions.count() : 0),
                               Eigen::VectorXd::Zero(K), Eigen::VectorXd::Zero(K)});
  const auto add_to_table = [&](Part& part, std::int64_t first, std::int64_t count) {
    std::vector<double> weights(static_cast<std::size_t>(functions.count()) * harmonic_block);
    for (std::int64_t p = 0; p < count; ++p) {
      const auto pixel = static_cast<std::size_t>(first + p);
      for (int i = 0; i < K; ++i) {
        const double mean = time_s[i] * by_mean(first + p, i);
        const double variance = time_s[i] * by_variance(first + p, i);
        double* const weight = weights.data() + i * harmonic_block + p;
        const double signal = light.signal_e_per_s[pixel];
        *weight = signal * (apart ? mean : mean + variance);
        if (apart) weight[K * harmonic_block] = signal * variance;
        part.by_ambient[i] += light.ambient_e_per_s[pixel] * mean;
        part.by_shot_ambient[i] += light.ambient_e_per_s[pixel] * variance;
      }
    }
    steps_->between.add(
        light.depth_bin.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)),
        weights.data(), part.functions);
  };
  const int shot = apart ? K * harmonic_block : 0;
  const auto add_to_light = [&](std::int64_t first, std::int64_t count, const double* values,
                                const double* slopes) {
    for (std::int64_t p = 0; p < count; ++p) {
      const double signal = light.signal_e_per_s[static_cast<std::size_t>(first + p)];
      for (int i = 0; i < K; ++i) {
        const std::int64_t at = i * harmonic_block + p;
        const double mean = time_s[i] * by_mean(first + p, i);
        const double variance = time_s[i] * by_variance(first + p, i);
        gradient.signal_e_per_s[first + p] += mean * values[at] + variance * values[at + shot];
        gradient.ambient_e_per_s[first + p] +=
            mean * table.ambient_gain[i] + variance * table.shot_ambient()[i];
        if (wanted.depth)
          gradient.depth_bin[first + p] +=
              signal * (mean * slopes[at] + variance * slopes[at + shot]);
      }
    }
  };
  parallel_for_blocks(pixels, in_a_group, [&](IndexRange range) {
    Part& part = parts[static_cast<std::size_t>(range.begin / in_a_group)];
    if (wanted.table)
      for (std::int64_t first = range.begin; first < range.end; first += harmonic_block)
        add_to_table(part, first, std::min<std::int64_t>(harmonic_block, range.end - first));
    if (wanted.light || wanted.depth)
      evaluate_blocks(steps_->between, functions, light.depth_bin, range, wanted.depth,
                      add_to_light);
  });
  if (!wanted.table || parts.empty()) return gradient;
  for (std::size_t g = 1; g < parts.size(); ++g) {
    parts[0].functions.add(parts[g].functions);
    parts[0].by_ambient += parts[g].by_ambient;
    parts[0].by_shot_ambient += parts[g].by_shot_ambient;
  }
  steps_->pull_back_functions(parts[0].functions, gradient.table);
  gradient.table.ambient_gain += parts[0].by_ambient;
  (apart ? gradient.table.shot_ambient_gain : gradient.table.ambient_gain) +=
      parts[0].by_shot_ambient;
  return gradient;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/depth_trials.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tofsmith/core/random.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr std::int64_t trials_per_block = 512;  // even: pairs of trials stay together

EvaluateOptions with_even_trials(EvaluateOptions options) {
  options.validate();
  options.trials += options.trials % 2;
  return options;
}

}  // namespace

DepthTrials::DepthTrials(const ForwardModel& model, const Camera& camera,
                         const EvaluateOptions& options)
    : DepthTrials(model, camera, options, make_decoding_table(model, camera)) {}

DepthTrials::DepthTrials(const ForwardModel& model, const Camera& camera,
                         const EvaluateOptions& options, DecodingTable believed)
    : options_(with_even_trials(options)),
      samples_(model.samples()),
      uniform_albedo_(camera.operating.uniform_albedo),
      albedo_(camera.operating.albedo),
      dark_e_per_s_(camera.sensor.dark_current_e_per_s),
      points_(camera.operating.points()),
      correlation_(model),
      noise_(camera.sensor),
      decoder_(make_decoder(options.method, std::move(believed), {}, options.unwrap_weights)),
      range_m_(camera.range_m()),
      exposure_s_(model.tap_exposure_s()),
      ambient_gain_(model.tap_ambient_gain()) {}

std::int64_t DepthTrials::blocks() const {
  return (options_.trials + trials_per_block - 1) / trials_per_block;
}

void DepthTrials::run(std::size_t point, const std::function<void(const TrialBlock&)>& use,
                      const Progress& progress) const {
  constexpr std::int64_t blocks_between_reports = 128;
  for (std::int64_t first = 0; first < blocks(); first += blocks_between_reports) {
    report(progress, static_cast<double>(first) / static_cast<double>(blocks()), "depth error");
    parallel_for(std::min(blocks_between_reports, blocks() - first), [&](std::int64_t i) {
      const std::int64_t begin = (first + i) * trials_per_block;
      std::vector<double> true_bin, decoded_bin;
      run_block(point, {begin, std::min(options_.trials, begin + trials_per_block)}, true_bin,
                decoded_bin);
      use({first + i, true_bin, decoded_bin});
    });
  }
}

void DepthTrials::run_block(std::size_t point, IndexRange trials, std::vector<double>& true_bin,
                            std::vector<double>& decoded_bin) const {
  const int taps = correlation_.tap_values();
  const int measurements = noise_.measurements(taps);
  const auto count = static_cast<std::size_t>(trials.end - trials.begin);
  true_bin.resize(count);
  decoded_bin.resize(count);
  std::vector<float> raw(count * static_cast<std::size_t>(measurements));
  std::vector<double> value(static_cast<std::size_t>(taps)), ambient_e(value), second(value);
  for (std::size_t j = 0; j < value.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    ambient_e[j] =
        exposure_s_[i] * (points_[point].ambient_e_per_s * ambient_gain_[i] + dark_e_per_s_);
  }

  float* out = raw.data();
  for (std::size_t t = 0; t < count; ++t, out += measurements) {
    const std::int64_t trial = trials.begin + static_cast<std::int64_t>(t);
    RandomStream random(options_.seed, point, static_cast<std::uint32_t>(trial));
    const double slice = (static_cast<double>(trial) + random.uniform()) /
                         static_cast<double>(options_.trials) * samples();
    true_bin[t] = options_.depth == DepthSampling::bins ? std::floor(slice) : slice;
    const double albedo = uniform_albedo_ ? random.uniform() : albedo_;
    const double signal_e_per_s = albedo * points_[point].signal_e_per_s;

    correlation_.at(true_bin[t], value.data());
    if (later_) add_second_return(true_bin[t], random, value, second);
    for (std::size_t j = 0; j < value.size(); ++j) {
      const double time_s = exposure_s_[static_cast<Eigen::Index>(j)];
      double electrons =
          noise_.draw_electrons(time_s * signal_e_per_s * value[j] + ambient_e[j], random);
      if (options_.clip_to_open_sensor)
        electrons =
            std::clamp(electrons, 0.0, time_s * (signal_e_per_s + points_[point].ambient_e_per_s));
      value[j] = noise_.convert(electrons);
    }
    noise_.read_out(value.data(), taps);
    for (int i = 0; i < measurements; ++i)
      out[i] = static_cast<float>(value[static_cast<std::size_t>(i)]);
  }
  decode(raw, decoded_bin);
}

void DepthTrials::add_second_return(double true_bin, RandomStream& random,
                                    std::vector<double>& value, std::vector<double>& second) const {
  const double ratio = later_->ratio(random.uniform());
  const double delay_bin = later_->delay_m(random.uniform()) / range_m_ * samples();
  correlation_.at(wrap(true_bin + delay_bin, samples()), second.data());
  for (std::size_t j = 0; j < value.size(); ++j) value[j] += ratio * second[j];
}

void DepthTrials::decode(const std::vector<float>& raw, std::vector<double>& decoded_bin) const {
  const auto count = static_cast<std::int64_t>(decoded_bin.size());
  if (two_return_) {
    two_return_->decode_depth_bins(raw.data(), count, decoded_bin.data());
    for (double& bin : decoded_bin)
      if (std::isnan(bin)) bin = 0.0;  // no depth: as good as any
    return;
  }
  std::visit(
      [&](const auto& decoder) {
        if (options_.sub_bin)
          return decoder.decode_depth_bins(raw.data(), count, decoded_bin.data());
        std::vector<std::int32_t> bins(decoded_bin.size());
        decoder.decode_bins(raw.data(), count, bins.data());
        std::copy(bins.begin(), bins.end(), decoded_bin.begin());
      },
      decoder_);
}

}  // namespace tofsmith

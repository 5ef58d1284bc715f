// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/multipath_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "camera/shared/depth_prior.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

/// Trials of one pixel as one row, with their direct depths.
struct TrialFrame {
  RawFrames raw;
  std::vector<double> true_m;
};

/// @param options  EvaluateOptions or MultipathErrorOptions: gives trials and seed
/// @param add  adds the light of a trial: (random, direct depth, work, sum)
template <typename Options, typename AddLight>
TrialFrame draw_frame(const PixelCapture& pixel, const Camera& camera, const Options& options,
                      std::uint64_t stream, double ambient_e_per_s, const AddLight& add) {
  const std::int64_t trials = options.trials;
  TrialFrame frame{empty_frames(1, 1, static_cast<int>(trials), pixel.measurements()),
                   std::vector<double>(static_cast<std::size_t>(trials))};
  const DepthPrior prior(camera);
  parallel_for_blocks(trials, 256, [&](IndexRange block) {
    const auto taps = static_cast<std::size_t>(pixel.tap_values());
    std::vector<double> work(taps), sum(taps);
    for (std::int64_t t = block.begin; t < block.end; ++t) {
      RandomStream random(options.seed, stream, static_cast<std::uint32_t>(t));
      const double part = (static_cast<double>(t) + random.uniform()) / static_cast<double>(trials);
      const double depth_m = prior.quantile(part) * camera.range_m();
      sum.assign(taps, 0.0);
      add(random, depth_m, work, sum);
      pixel.expose(ambient_e_per_s, random, sum,
                   frame.raw.values.data() + t * pixel.measurements());
      frame.true_m[static_cast<std::size_t>(t)] = depth_m;
    }
  });
  return frame;
}

TrialFrame draw_two_returns(const PixelCapture& pixel, const Camera& camera,
                            const OperatingMultipath& later, const EvaluateOptions& options,
                            std::size_t point) {
  const OperatingPoint light = camera.operating.points()[point];
  return draw_frame(pixel, camera, options, point, light.ambient_e_per_s,
                    [&](RandomStream& random, double depth_m, std::vector<double>& work,
                        std::vector<double>& sum) {
                      const double albedo = camera.operating.uniform_albedo
                                                ? random.uniform()
                                                : camera.operating.albedo;
                      const double signal_e_per_s = albedo * light.signal_e_per_s;
                      const double ratio = later.ratio_at(random.uniform());
                      const double delay_m = later.delay_at_m(random.uniform());
                      pixel.add_light(depth_m, signal_e_per_s, work, sum);
                      pixel.add_light(depth_m + delay_m, ratio * signal_e_per_s, work, sum);
                    });
}

template <typename DecoderType>
OperatingMultipathError error_of(const PixelCapture& pixel, const Camera& camera,
                                 const OperatingMultipath& later, const EvaluateOptions& options,
                                 const DecoderType& decoder, const Progress& progress) {
  const double range_m = camera.range_m();
  std::vector<Estimate> linear_m, circular_m;
  const std::size_t points = camera.operating.points().size();
  const ProgressParts parts(progress, points);
  for (std::size_t p = 0; p < points; ++p) {
    report(parts[p], 0.0, "second returns");
    const TrialFrame frame = draw_two_returns(pixel, camera, later, options, p);
    const Image<float> depth_m = decoder.decode(frame.raw, 0, parts[p]).depth_m;
    RunningStatistics linear, circular;
    for (std::size_t t = 0; t < frame.true_m.size(); ++t) {
      // Any value is equally good for a pixel without decoded depth.
      const double decoded_m = std::isnan(depth_m.pixels[t]) ? 0.0 : depth_m.pixels[t];
      linear.add(std::abs(decoded_m - frame.true_m[t]));
      circular.add(std::abs(circular_difference(decoded_m, frame.true_m[t], range_m)));
    }
    linear_m.push_back(linear.estimate());
    circular_m.push_back(circular.estimate());
  }
  report(progress, 1.0, "second returns");
  return {geometric_mean_of(linear_m), geometric_mean_of(circular_m)};
}

}  // namespace

OperatingMultipathReport operating_multipath_report(const CodeSet& code, const Camera& on,
                                                    const OperatingMultipath& later,
                                                    const EvaluateOptions& options,
                                                    const Progress& progress) {
  const Camera camera = judged_camera(on);
  options.validate();
  later.validate(camera.range_m());
  const ForwardModel model(code, camera);
  const PixelCapture pixel(model, camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const ProgressParts parts(progress, {30, 70});
  OperatingMultipathReport result;
  result.single_path = error_of(pixel, camera, later, options, Decoder(table), parts[0]);
  if (TwoReturnDecoder::why_not_decodable(table)) {
    report(progress, 1.0, "second returns");
    return result;
  }
  MultipathOptions decoding;
  decoding.shortest_delay_m = std::min(decoding.shortest_delay_m, later.delay_m[0]);
  decoding.longest_delay_m = std::max(later.delay_m[1], camera.range_m() / 3);
  result.two_return =
      error_of(pixel, camera, later, options, TwoReturnDecoder(table, decoding), parts[1]);
  return result;
}

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

struct CellLight {
  double signal_e_per_s = 0.0;
  double ratio = 0.0;
  double delay_m = 0.0;
  bool is_tail = false;
};

class CellTrials {
 public:
  CellTrials(const CodeSet& code, const Camera& camera, const MultipathErrorOptions& options)
      : options_(options),
        camera_(camera),
        model_(code, camera),
        pixel_(model_, camera),
        table_(make_decoding_table(model_, camera)),
        single_(table_),
        bound_(model_, camera) {}

  int measurements() const { return pixel_.measurements(); }
  const DecodingTable& table() const { return table_; }

  /// @param decoder  for two returns or a tail
  template <typename DecoderType>
  MultipathCell cell(const CellLight& light, std::uint64_t number,
                     const std::optional<DecoderType>& decoder, const Progress& progress) const;

 private:
  TrialFrame capture(const CellLight& light, std::uint64_t number) const;
  void add_errors(const Image<float>& depth_m, const std::vector<double>& true_m, Estimate& bias_m,
                  Estimate& error_m) const;
  double cramer_rao_mae_m(const CellLight& light) const;

  const MultipathErrorOptions& options_;
  const Camera& camera_;
  ForwardModel model_;
  PixelCapture pixel_;
  DecodingTable table_;
  Decoder single_;
  MultipathBound bound_;
};

TrialFrame CellTrials::capture(const CellLight& light, std::uint64_t number) const {
  const int points_per_bin = model_.straight_points_per_bin(16);
  std::optional<FineCorrelation> tail;
  if (light.is_tail)
    tail.emplace(tap_tail_table(model_, {light.delay_m, light.ratio}, camera_.range_m(),
                                points_per_bin * model_.samples()),
                 points_per_bin);
  const double later = light.ratio * light.signal_e_per_s;
  return draw_frame(
      pixel_, camera_, options_, number, options_.ambient_e_per_s,
      [&](RandomStream&, double depth_m, std::vector<double>& work, std::vector<double>& sum) {
        pixel_.add_light(depth_m, light.signal_e_per_s, work, sum);
        if (tail)
          pixel_.add_light(*tail, depth_m, later, work, sum);
        else if (later > 0.0)
          pixel_.add_light(depth_m + light.delay_m, later, work, sum);
      });
}

void CellTrials::add_errors(const Image<float>& depth_m, const std::vector<double>& true_m,
                            Estimate& bias_m, Estimate& error_m) const {
  RunningStatistics bias, error;
  const double range_m = camera_.range_m();
  for (std::size_t t = 0; t < true_m.size(); ++t) {
    // A pixel without decoded depth has the mean error of a guess.
    const double decoded = depth_m.pixels[t];
    const double off =
        std::isnan(decoded) ? 0.25 * range_m : circular_difference(decoded, true_m[t], range_m);
    bias.add(off);
    error.add(std::abs(off));
  }
  bias_m = bias.estimate();
  error_m = error.estimate();
}

double CellTrials::cramer_rao_mae_m(const CellLight& light) const {
  const OperatingPoint point{light.signal_e_per_s, options_.ambient_e_per_s};
  return bound_.mae_m(light.is_tail ? bound_.tail_sigma_m(point, {light.delay_m, light.ratio})
                                    : bound_.sigma_m(point, light.ratio, light.delay_m));
}

template <typename DecoderType>
MultipathCell CellTrials::cell(const CellLight& light, std::uint64_t number,
                               const std::optional<DecoderType>& decoder,
                               const Progress& progress) const {
  MultipathCell result;
  result.ratio = light.ratio;
  result.delay_m = light.delay_m;
  result.law_m = single_path_bias_m(light.ratio, light.delay_m);
  result.bias_m = result.error_m = {no_number, no_number};
  result.cramer_rao_mae_m = no_number;
  const TrialFrame frame = capture(light, number);
  const ProgressParts parts(progress, {10, 90});
  add_errors(single_.decode(frame.raw, 0, parts[0]).depth_m, frame.true_m, result.single_bias_m,
             result.single_error_m);
  if (!decoder) return result;
  const DepthImage image = decoder->decode(frame.raw, 0, parts[1]);
  add_errors(image.depth_m, frame.true_m, result.bias_m, result.error_m);
  const auto share = [&](ReturnStatus status) {
    return static_cast<double>(
               std::count(image.returns.pixels.begin(), image.returns.pixels.end(), status)) /
           static_cast<double>(frame.true_m.size());
  };
  result.two_share = share(ReturnStatus::two);
  result.unresolved_share = share(ReturnStatus::unresolved);
  if (light.ratio > 0.0) result.cramer_rao_mae_m = cramer_rao_mae_m(light);
  return result;
}

template <typename DecoderType>
std::optional<DecoderType> decoder_if_any(const DecodingTable& table,
                                          const MultipathOptions& options, std::string& why_not) {
  if (const auto why = DecoderType::why_not_decodable(table)) {
    why_not = *why;
    return std::nullopt;
  }
  return DecoderType(table, options);
}

}  // namespace

void MultipathErrorOptions::validate(double range_m) const {
  const auto below_range = [range_m](const std::vector<double>& values, const char* field) {
    for (const double value : values)
      require(value < range_m, field, value,
              "must be > 0 and below the range, " + fmt::format("{:f}", range_m) + " m");
  };
  for_each_field(*this, [](const auto& field) {
    if constexpr (requires { field.value.empty(); })
      require(!field.value.empty(), std::string("MultipathErrorOptions::") + field.name, "nothing",
              "must have at least one entry");
  });
  check_fields(*this, "MultipathErrorOptions::");
  below_range(delay_m, "MultipathErrorOptions::delay_m");
  below_range(tail_m, "MultipathErrorOptions::tail_m");
  decoding.validate(range_m);
}

MultipathErrorReport multipath_error(const CodeSet& code, const Camera& camera,
                                     const MultipathErrorOptions& options,
                                     const Progress& progress) {
  camera.validate();
  options.validate(camera.range_m());
  const CellTrials trials(code, camera, options);
  MultipathErrorReport result;
  result.code = code.name();
  result.measurements = trials.measurements();
  const auto two =
      decoder_if_any<TwoReturnDecoder>(trials.table(), options.decoding, result.why_no_two_returns);
  std::vector<std::optional<TailDecoder>> tails;
  for (const double tail_m : options.tail_m) {
    MultipathOptions decoding = options.decoding;
    decoding.tail_m = tail_m;
    tails.push_back(decoder_if_any<TailDecoder>(trials.table(), decoding, result.why_no_tail));
  }

  const std::size_t cells =
      options.signal_e_per_s.size() *
      (2 + options.ratio.size() * (options.delay_m.size() + options.tail_m.size()));
  const ProgressParts parts(progress, cells);
  std::uint64_t number = 0;
  const auto measure = [&](const CellLight& light, const auto& decoder) {
    const Progress part = parts[number];
    report(part, 0.0, "multi-path");
    return trials.cell(light, number++, decoder, part);
  };
  for (const double signal : options.signal_e_per_s) {
    MultipathMaps maps;
    maps.signal_e_per_s = signal;
    maps.single = measure({signal}, two);
    maps.single_by_tail = measure({signal}, tails[tails.size() / 2]);
    for (const double r : options.ratio) {
      for (const double delay_m : options.delay_m)
        maps.points.push_back(measure({signal, r, delay_m}, two));
      for (std::size_t i = 0; i < tails.size(); ++i)
        maps.tails.push_back(measure({signal, r, options.tail_m[i], true}, tails[i]));
    }
    result.maps.push_back(std::move(maps));
  }
  report(progress, 1.0, "multi-path");
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <algorithm>
#include <cmath>

#include "camera/shared/depth_prior.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

namespace {

/// Trials of one operating point as one row, with their direct depths.
struct TrialFrame {
  RawFrames raw;
  std::vector<double> true_m;
};

TrialFrame draw_frame(const PixelCapture& pixel, const Camera& camera,
                      const OperatingMultipath& later, const EvaluateOptions& options,
                      std::size_t point) {
  const OperatingPoint light = camera.operating.points()[point];
  const std::int64_t trials = options.trials;
  TrialFrame frame;
  frame.raw.frames = frame.raw.height = 1;
  frame.raw.width = static_cast<int>(trials);
  frame.raw.measurements = pixel.measurements();
  frame.raw.values.resize(static_cast<std::size_t>(trials * pixel.measurements()));
  frame.true_m.resize(static_cast<std::size_t>(trials));
  const DepthPrior prior(camera);
  parallel_for_blocks(trials, 256, [&](IndexRange block) {
    const auto taps = static_cast<std::size_t>(pixel.tap_values());
    std::vector<double> work(taps), sum(taps);
    for (std::int64_t t = block.begin; t < block.end; ++t) {
      RandomStream random(options.seed, point, static_cast<std::uint32_t>(t));
      const double part = (static_cast<double>(t) + random.uniform()) / static_cast<double>(trials);
      const double depth_m = prior.quantile(part) * camera.range_m();
      const double albedo =
          camera.operating.uniform_albedo ? random.uniform() : camera.operating.albedo;
      const double signal_e_per_s = albedo * light.signal_e_per_s;
      const double ratio = later.ratio_at(random.uniform());
      const double delay_m = later.delay_at_m(random.uniform());
      sum.assign(taps, 0.0);
      pixel.add_light(depth_m, signal_e_per_s, work, sum);
      pixel.add_light(depth_m + delay_m, ratio * signal_e_per_s, work, sum);
      pixel.expose(light.ambient_e_per_s, random, sum,
                   frame.raw.values.data() + t * pixel.measurements());
      frame.true_m[static_cast<std::size_t>(t)] = depth_m;
    }
  });
  return frame;
}

template <typename DepthOf>
OperatingMultipathError error_of(const PixelCapture& pixel, const Camera& camera,
                                 const OperatingMultipath& later, const EvaluateOptions& options,
                                 const Progress& progress, DepthOf&& depth_of) {
  const double range_m = camera.range_m();
  std::vector<Estimate> linear_m, circular_m;
  const std::size_t points = camera.operating.points().size();
  const ProgressParts parts(progress, points);
  for (std::size_t p = 0; p < points; ++p) {
    report(parts[p], 0.0, "second returns");
    const TrialFrame frame = draw_frame(pixel, camera, later, options, p);
    const Image<float> depth_m = depth_of(frame.raw, parts[p]);
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

struct OperatingMultipathTrials {
  OperatingMultipathTrials(const CodeSet& code, const Camera& on, const OperatingMultipath& met,
                           const EvaluateOptions& how)
      : camera(judged_camera(on)),
        later(met),
        options(how),
        model(checked_model(code)),
        pixel(model, camera) {}

  OperatingMultipathError single_path(const Progress& progress) const {
    const Decoder decoder(make_decoding_table(model, camera));
    return error_of(pixel, camera, later, options, progress,
                    [&](const RawFrames& raw, const Progress& part) {
                      return decoder.decode(raw, 0, part).depth_m;
                    });
  }

  /// @throws std::invalid_argument for codes that cannot separate two returns
  OperatingMultipathError two_return(const Progress& progress) const {
    MultipathOptions decoding;
    decoding.shortest_delay_m = std::min(decoding.shortest_delay_m, later.delay_m[0]);
    decoding.longest_delay_m = std::max(later.delay_m[1], camera.range_m() / 3);
    const TwoReturnDecoder decoder(make_decoding_table(model, camera), decoding);
    return error_of(pixel, camera, later, options, progress,
                    [&](const RawFrames& raw, const Progress& part) {
                      return decoder.decode(raw, 0, part).depth_m;
                    });
  }

  ForwardModel checked_model(const CodeSet& code) const {
    options.validate();
    later.validate(camera.range_m());
    return ForwardModel(code, camera);
  }

  const Camera camera;
  const OperatingMultipath& later;
  const EvaluateOptions& options;
  ForwardModel model;
  PixelCapture pixel;
};

}  // namespace

OperatingMultipathReport operating_multipath_report(const CodeSet& code, const Camera& camera,
                                                    const OperatingMultipath& later,
                                                    const EvaluateOptions& options,
                                                    const Progress& progress) {
  const OperatingMultipathTrials trials(code, camera, later, options);
  const ProgressParts parts(progress, {30, 70});
  OperatingMultipathReport result;
  result.single_path = trials.single_path(parts[0]);
  if (TwoReturnDecoder::why_not_decodable(make_decoding_table(trials.model, camera)))
    report(progress, 1.0, "second returns");
  else
    result.two_return = trials.two_return(parts[1]);
  return result;
}

}  // namespace tofsmith

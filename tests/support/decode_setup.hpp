// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "decode/search/direction_table.hpp"
#include "generated_shapes.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"
#include "tofsmith/decode/unwrap_decoder.hpp"

namespace tofsmith {

/// A code, a camera and the matching decoder.
template <typename DecoderType, typename Options>
struct DecoderSetup {
  Camera camera;
  ForwardModel model;
  DecoderType decoder;

  DecoderSetup(const std::string& code, const Camera& camera_, const Options& options = {})
      : camera(camera_),
        model(build_family(code, camera), camera),
        decoder(make_decoding_table(model, camera), options) {}

  void append_expected(std::vector<float>& raw, double signal, double depth_bin,
                       double ambient) const {
    const Return r{signal, depth_bin};
    for (const double e : model.expected_electrons({&r, 1}, ambient))
      raw.push_back(static_cast<float>(e));
  }
};

using DecodeSetup = DecoderSetup<Decoder, DecodeOptions>;

inline Camera camera_with(const std::string& name, int taps = 1,
                          Readout readout = Readout::separate) {
  Camera camera = built_in_camera(name);
  camera.sensor.taps = taps;
  camera.sensor.readout = readout;
  return camera;
}

inline DecodingTable decoding_table_of(const std::string& code, const Camera& camera) {
  return make_decoding_table(ForwardModel(build_family(code, camera), camera), camera);
}

struct Moments {
  double mean_e, variance_e2;
};

/// Returns the moments of a pixel's measurement k, interpolated linearly between table rows.
inline Moments moments_of(const DecodingTable& table, double signal, double ambient,
                          double depth_bin, int k) {
  const double row = depth_bin * table.samples() / table.bin_count();
  const int from = static_cast<int>(row), to = (from + 1) % table.samples();
  const double t = row - from;
  const double chi = (1 - t) * table.correlation(from, k) + t * table.correlation(to, k);
  const double shot_chi = (1 - t) * table.shot()(from, k) + t * table.shot()(to, k);
  const double mean = table.exposure_s[k] * (signal * chi + ambient * table.ambient_gain[k]);
  const double variance =
      table.exposure_s[k] * (signal * shot_chi + ambient * table.shot_ambient()[k]) +
      table.shot_dark()[k] + table.constant_variance_e2[k];
  return {mean + table.dark_electrons[k], variance};
}

/// Appends the raw values of a pixel (K).
/// @param random  noise; none if null
inline void append_pixel(const DecodingTable& table, double signal, double ambient,
                         double depth_bin, RandomStream* random, std::vector<float>& raw) {
  for (int k = 0; k < table.measurements(); ++k) {
    const Moments of = moments_of(table, signal, ambient, depth_bin, k);
    const double electrons =
        of.mean_e + (random ? std::sqrt(of.variance_e2) * random->normal() : 0.0);
    raw.push_back(static_cast<float>(electrons / table.gain_e_per_raw[k] + table.black_level[k]));
  }
}
inline void append_noisy_pixel(const DecodingTable& table, double signal, double ambient,
                               double depth_bin, RandomStream& random, std::vector<float>& raw) {
  append_pixel(table, signal, ambient, depth_bin, &random, raw);
}

/// Raw values (pixels, K) at random depths.
inline std::vector<float> noisy_pixels(const DecodingTable& table, double signal, double ambient,
                                       int pixels, std::uint64_t seed) {
  std::vector<float> raw;
  raw.reserve(static_cast<std::size_t>(pixels * table.measurements()));
  RandomStream random(seed, 0);
  for (int i = 0; i < pixels; ++i) {
    const double depth_bin = table.bin_count() * random.uniform();
    append_noisy_pixel(table, signal, ambient, depth_bin, random, raw);
  }
  return raw;
}

/// Builds a frame pixel by pixel.
/// @param append  called as (row, column, random, values); appends the raw values of one pixel
template <typename AppendPixel>
RawFrames frame_by_pixel(int measurements, int height, int width, std::uint64_t seed,
                         const AppendPixel& append) {
  RawFrames frame{
      .frames = 1, .height = height, .width = width, .measurements = measurements, .values = {}};
  RandomStream random(seed, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) append(y, x, random, frame.values);
  return frame;
}

struct Seen {
  double depth_bin = 0.0, signal_e_per_s = 0.0;
};
using SceneOfPixels = std::function<Seen(int row, int column)>;

inline RawFrames frame_seen(const DecodingTable& table, int height, int width,
                            const SceneOfPixels& scene, double ambient_e_per_s = 1e4,
                            std::uint64_t seed = 1) {
  return frame_by_pixel(table.measurements(), height, width, seed,
                        [&](int y, int x, RandomStream& random, std::vector<float>& raw) {
                          const Seen seen = scene(y, x);
                          append_noisy_pixel(table, seen.signal_e_per_s, ambient_e_per_s,
                                             seen.depth_bin, random, raw);
                        });
}

/// Dim to bright signals, in ambient light from a hundred times the signal to a thousandth of it.
inline std::vector<float> pixels_at_all_light_levels(const DecodingTable& table, int each) {
  std::vector<float> raw;
  std::uint64_t seed = 1;
  for (const auto& [signal, ambient] :
       {OperatingPoint{1e3, 1e5}, OperatingPoint{3e3, 1e3}, OperatingPoint{1e4, 1e4},
        OperatingPoint{1e5, 1e2}, OperatingPoint{1e7, 1e5}}) {
    const std::vector<float> more = noisy_pixels(table, signal, ambient, each, seed++);
    raw.insert(raw.end(), more.begin(), more.end());
  }
  return raw;
}

template <typename DecoderType>
std::vector<std::int32_t> bins_of(const DecoderType& decoder, const std::vector<float>& raw) {
  std::vector<std::int32_t> bins(raw.size() / static_cast<std::size_t>(decoder.measurements()));
  decoder.decode_bins(raw.data(), static_cast<std::int64_t>(bins.size()), bins.data());
  return bins;
}

template <typename DecoderType>
std::vector<double> depth_bins_of(const DecoderType& decoder, const std::vector<float>& raw) {
  std::vector<double> bins(raw.size() / static_cast<std::size_t>(decoder.measurements()));
  decoder.decode_depth_bins(raw.data(), static_cast<std::int64_t>(bins.size()), bins.data());
  return bins;
}

inline RawFrames frame_of(const std::vector<float>& raw, int measurements) {
  RawFrames frames;
  frames.frames = frames.height = 1;
  frames.width = static_cast<int>(raw.size()) / measurements;
  frames.measurements = measurements;
  frames.values = raw;
  return frames;
}

/// Returns the measurements of all pixels (pixels, K).
inline std::vector<float> values_of(const RawView& raw) {
  std::vector<float> values(static_cast<std::size_t>(raw.pixels() * raw.measurements));
  copy_pixels(raw, 0, raw.pixels(), values.data());
  return values;
}

/// Decodes one row of pixels to the usual planes and the residual.
inline DepthImage decode_row(DecodeMethod method, const DecodingTable& table,
                             const std::vector<float>& raw, const DecodeOptions& options = {},
                             const float* averaged = nullptr) {
  const RawFrames frame = frame_of(raw, table.measurements());
  RawView view = view_of_frame(frame, 0);
  view.averaged = averaged;
  DepthImage image(1, frame.width);
  image.residual = image.depth_m;
  make_decoder(method, table, options)->decode(view, DecodedView::of(image));
  return image;
}

/// Decodes to the usual planes and the residual.
inline DepthImage decode_filtered(const Decoder& decoder, const FilteredFrame& filtered) {
  DepthImage image(filtered.height(), filtered.width());
  image.residual = image.depth_m;
  decoder.decode(filtered.view(), DecodedView::of(image));
  return image;
}

using LikelihoodSetup = DecoderSetup<LikelihoodDecoder, DecodeOptions>;

using UnwrapSetup = DecoderSetup<UnwrapDecoder, UnwrapOptions>;

inline DirectionTable directions_of(const Curve& curve) {
  DecodingTable table;
  table.correlation = curve;
  table.ambient_gain = Eigen::VectorXd::Zero(curve.cols());
  table.exposure_s = Eigen::VectorXd::Ones(curve.cols());
  return DirectionTable(AmbientProjection(table));
}

/// The code has `code_samples` bins; ambient light is projected out.
inline DirectionTable directions_of(const std::string& code, int code_samples, int samples) {
  Camera camera = camera_with("paper-10f0");
  camera.samples = code_samples;
  const CodeSet set = build_family(code, camera).resampled(samples);
  camera.samples = samples;
  return DirectionTable(AmbientProjection(make_decoding_table(ForwardModel(set, camera), camera)));
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "tofsmith/code/families.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

/// Two surfaces with mixed pixels between them.
RawFrames edge_seen(const ForwardModel& model, int height, int width) {
  RawFrames raw{.frames = 1,
                .height = height,
                .width = width,
                .measurements = model.measurements(),
                .values = {}};
  for (int i = 0; i < height * width; ++i) {
    const int x = i % width;
    const double near = x < width / 2 ? 1e5 : x == width / 2 ? 6e4 : 0.0;
    const std::array returns = {Return{near, 70.0}, Return{1e5 - near, 120.0}};
    for (const double e : model.expected_electrons(returns, 1e4))
      raw.values.push_back(static_cast<float>(e));
  }
  return raw;
}

DecodeRequest request_of(const RawFrames& raw, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::create_directories(folder);
  DecodeRequest request;
  request.raw = {folder / "raw.npy"};
  request.output = folder / "depth.npy";
  request.policy = OutputPolicy::overwrite;
  write_npy(request.raw.front(),
            NpyArray::of<float>(
                {static_cast<std::size_t>(raw.height), static_cast<std::size_t>(raw.width),
                 static_cast<std::size_t>(raw.measurements)},
                raw.values),
            OutputPolicy::overwrite);
  return request;
}

void expect_decoded(const DecodeRequest& request, const FrameBackend& backend,
                    const Image<float>& expected) {
  decode_recording(request, backend);
  const Image<float> depth = read_float_image(request.output, "depth");
  ASSERT_EQ(depth.size(), expected.size());
  for (std::size_t i = 0; i < depth.size(); ++i)
    EXPECT_TRUE(depth.pixels[i] == expected.pixels[i] ||
                (std::isnan(depth.pixels[i]) && std::isnan(expected.pixels[i])))
        << i;
}

TEST(MixedRecording, FilesEqualTheMarkedFrameEvenIfOnlyDepthIsWritten) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const RawFrames raw = edge_seen(model, 24, 31);
  DecodeRequest request = request_of(raw, "mixed_recording");
  const Decoder decoder(table);
  const std::unique_ptr<FrameBackend> backend =
      cpu_backend(make_decoder(DecodeMethod::zncc, table));
  for (const MixedPixels mixed : all_mixed_pixels) {
    DepthImage expected = decoder.decode(raw);
    EXPECT_GT(mark_mixed_pixels(table, view_of_frame(raw, 0), mixed, DecodedView::of(expected)),
              raw.height - 3);
    request.mixed = mixed;
    expect_decoded(request, *backend, expected.depth_m);
  }
}

TEST(MixedRecording, FilteredFramesAreFilteredAgainWithoutMixedPixels) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const RawFrames raw = edge_seen(model, 24, 31);
  const RawView measured = view_of_frame(raw, 0);
  const Decoder decoder(table);
  const Filter filter(table);
  FilteredFrame filtered;
  filter.apply(measured, filtered);
  DepthImage first(raw.height, raw.width);
  decoder.decode(filtered.view(), DecodedView::of(first));
  UnfilteredPixels unfiltered{.measured = &measured};
  EXPECT_GT(mark_mixed_pixels(table, filtered.view(), MixedPixels::label, DecodedView::of(first),
                              {}, {}, unfiltered),
            raw.height - 3);
  unfiltered.mixed = Image<std::uint8_t>(raw.height, raw.width);
  for (std::size_t i = 0; i < first.status.size(); ++i)
    unfiltered.mixed.pixels[i] = first.status.pixels[i] == PixelStatus::mixed ? 1 : 0;
  filter.apply(measured, filtered, {}, unfiltered.mixed);

  DecodeRequest request = request_of(raw, "mixed_and_filtered");
  request.filter = FilterOptions();
  for (const MixedPixels mixed : all_mixed_pixels) {
    DepthImage expected(raw.height, raw.width);
    decoder.decode(filtered.view(), DecodedView::of(expected));
    mark_mixed_pixels(table, filtered.view(), mixed, DecodedView::of(expected), {}, {}, unfiltered);
    request.mixed = mixed;
    expect_decoded(request, *cpu_backend(make_decoder(DecodeMethod::zncc, table)),
                   expected.depth_m);
  }
}

}  // namespace
}  // namespace tofsmith

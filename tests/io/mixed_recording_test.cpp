// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "tofsmith/code/families.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

/// Pixels of two surfaces and, between them, of both; without noise.
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

TEST(MixedRecording, FilesHoldWhatMarkingAFrameGivesThoughOnlyDepthIsWritten) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const RawFrames raw = edge_seen(model, 24, 31);
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "mixed_recording";
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
  const Decoder decoder(table);
  const AnyDecoder any = make_decoder(DecodeMethod::zncc, table);
  for (const MixedPixels mixed : all_mixed_pixels) {
    DepthImage expected = decoder.decode(raw);
    EXPECT_GT(mark_mixed_pixels(table, view_of_frame(raw, 0), mixed, DecodedView::of(expected)),
              raw.height - 3);
    request.mixed = mixed;
    decode_recording(request, any);
    const Image<float> depth = read_float_image(request.output, "depth");
    ASSERT_EQ(depth.size(), expected.depth_m.size());
    for (std::size_t i = 0; i < depth.size(); ++i)
      EXPECT_TRUE(depth.pixels[i] == expected.depth_m.pixels[i] ||
                  (std::isnan(depth.pixels[i]) && std::isnan(expected.depth_m.pixels[i])));
  }
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <span>

#include "decode_recording_fixture.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class DecodeStream : public DecodeRecording {
 protected:
  DecodeStream() {
    std::ofstream(path("s.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 4\nbits = 32\n"
                                         "numbers = \"float\"\nlayout = \"interleaved\"\n"
                                         "header_bytes = 3\n";
    const auto bytes = std::as_bytes(std::span(raw_.values));
    stream_.assign(3, std::byte{7});
    stream_.insert(stream_.end(), bytes.begin(), bytes.end());
    std::ofstream(path("dump.bin"), std::ios::binary)
        .write(reinterpret_cast<const char*>(stream_.data()), std::ssize(stream_));
  }

  /// Decodes the first `bytes` of the stream. Each frame is written before the next one is read,
  /// apart from the look-ahead of a time filter.
  DecodedStream run(DecodeRequest request, std::size_t bytes) {
    request.raw_format = path("s.raw.toml");
    std::size_t at = 0;
    written_.clear();
    DecodedStream result;
    const ReadStream read = [&](std::span<std::byte> into) {
      const std::size_t frames = at < 3 ? 0 : (at - 3) / (6 * 5 * 4 * sizeof(float));
      const std::size_t waiting =
          request.time_filter ? static_cast<std::size_t>(request.time_filter->look_ahead) : 0;
      if (request.average == 1 && !request.sliding) {
        EXPECT_EQ(result.frames, static_cast<std::int64_t>(frames - std::min(frames, waiting)));
      }
      const std::size_t count = std::min(into.size(), bytes - at);
      std::copy_n(stream_.begin() + static_cast<std::ptrdiff_t>(at), count, into.begin());
      at += count;
      return count;
    };
    const WriteStream write = [&](std::span<const std::byte> bytes_of_plane) {
      written_.insert(written_.end(), bytes_of_plane.begin(), bytes_of_plane.end());
    };
    decode_stream(request, *backend_, read, write, {}, result);
    return result;
  }
  std::vector<std::byte> of_files(DecodeRequest request) {
    request.raw = {path("dump.bin")};
    request.raw_format = path("s.raw.toml");
    request.output = path("stack.npy");
    request.stack = true;
    request.policy = OutputPolicy::overwrite;
    const DecodedRecording result = decode_recording(request, *backend_);
    std::vector<std::byte> bytes;
    for (std::size_t frame = 0; frame < result.frames.size(); ++frame)
      for (const std::filesystem::path& file : result.files) {
        const NpyArray array = read_npy(file);
        const std::size_t size = array.bytes().size() / result.frames.size();
        const auto part = array.bytes().subspan(frame * size, size);
        bytes.insert(bytes.end(), part.begin(), part.end());
      }
    return bytes;
  }

  std::vector<std::byte> stream_, written_;
};

TEST_F(DecodeStream, GivesTheBytesOfFilesFrameByFrame) {
  DecodeRequest plain, filtered, means, ahead;
  ahead.outputs = {DecodedPlane::depth};
  plain.outputs = {DecodedPlane::depth, DecodedPlane::status};
  filtered.outputs = {DecodedPlane::depth, DecodedPlane::bin};
  filtered.filter = FilterOptions{};
  filtered.time_filter = TimeFilterOptions{};
  filtered.offset_m = 0.5;
  means.outputs = {DecodedPlane::signal};
  means.average = 2;
  for (const int frames : {1, 2, 7}) {
    ahead.time_filter = TimeFilterOptions{.look_ahead = frames};
    EXPECT_EQ(run(ahead, stream_.size()).frames, 3);
    EXPECT_EQ(written_, of_files(ahead));
  }
  for (const DecodeRequest& request : {plain, filtered, means}) {
    const DecodedStream result = run(request, stream_.size());
    EXPECT_EQ(result.frames, request.average == 2 ? 2 : 3);
    EXPECT_EQ(written_, of_files(request));
  }
  EXPECT_EQ(run(plain, stream_.size()).statuses.pixels(), 3 * 6 * 5);
  run({}, stream_.size());
  DecodeRequest depth;
  depth.outputs = {DecodedPlane::depth};
  EXPECT_EQ(written_, of_files(depth)) << "depth, if nothing is asked for";
}

TEST_F(DecodeStream, GivesTheBytesOfSlidingWindows) {
  DecodeRequest request;
  request.sliding = true;
  request.outputs = {DecodedPlane::depth, DecodedPlane::status};
  for (const bool in_time : {false, true}) {
    if (in_time) request.time_filter = TimeFilterOptions{};
    EXPECT_EQ(run(request, stream_.size()).frames, 2 * 4 + 1);
    EXPECT_EQ(written_, of_files(request));
  }
}

TEST_F(DecodeStream, GivesAnImageAfterEachExposureOfPlanarFrames) {
  const std::size_t image = 6 * 5 * sizeof(float);
  std::vector<std::byte> planar;
  for (int f = 0; f < 3; ++f)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < 6 * 5; ++i) {
        const auto bytes = std::as_bytes(std::span(raw_.frame(f) + 4 * i + k, 1));
        planar.insert(planar.end(), bytes.begin(), bytes.end());
      }
  std::ofstream(path("p.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 4\nbits = 32\n"
                                       "numbers = \"float\"\nlayout = \"planar\"\n";
  DecodeRequest request;
  request.sliding = true;
  request.outputs = {DecodedPlane::depth};
  const std::vector<std::byte> expected = of_files(request);
  request.raw_format = path("p.raw.toml");
  std::size_t at = 0;
  std::vector<std::byte> written;
  std::vector<std::size_t> images_read;  // before each image that comes out
  const ReadStream read = [&](std::span<std::byte> into) {
    const std::size_t count = std::min(into.size(), planar.size() - at);
    std::copy_n(planar.begin() + static_cast<std::ptrdiff_t>(at), count, into.begin());
    at += count;
    return count;
  };
  const WriteStream write = [&](std::span<const std::byte> plane) {
    images_read.push_back(at / image);
    written.insert(written.end(), plane.begin(), plane.end());
  };
  DecodedStream result;
  decode_stream(request, *backend_, read, write, {}, result);
  EXPECT_EQ(images_read, (std::vector<std::size_t>{4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(written, expected);
}

TEST_F(DecodeStream, SupportsRotatedImagesAndTrailers) {
  std::ofstream(path("s.raw.toml"), std::ios::app)
      << "rotate_deg = 90\nnegate_rows = \"odd\"\ntrailer_bytes = 2\n";
  stream_.resize(stream_.size() + 2);
  std::ofstream(path("dump.bin"), std::ios::app | std::ios::binary) << "  ";
  DecodeRequest request;
  request.outputs = {DecodedPlane::depth, DecodedPlane::status};
  const DecodedStream result = run(request, stream_.size());
  EXPECT_EQ(result.frames, 3);
  EXPECT_EQ(result.height, 5);
  EXPECT_EQ(result.width, 6);
  EXPECT_EQ(written_, of_files(request));
}

TEST_F(DecodeStream, KeepsTheFramesBeforeATruncation) {
  const std::size_t frame = 6 * 5 * 4 * sizeof(float);
  EXPECT_THAT([&] { run({}, 3 + 2 * frame + 7); },
              ThrowsMessage<IoError>(AllOf(HasSubstr("found 7 bytes and the end"),
                                           HasSubstr("expected 480 of frame 2"))));
  EXPECT_EQ(written_.size(), 2 * 6 * 5 * sizeof(float));
  EXPECT_THAT([&] { run({}, 3); }, ThrowsMessage<IoError>(HasSubstr("frame 0")));
  EXPECT_THAT([&] { run({}, 2); }, ThrowsMessage<IoError>(HasSubstr("header")));
  DecodeRequest stack;
  stack.stack = true;
  EXPECT_THAT([&] { run(stack, 3); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is only valid with files")));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/decode_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Three frames of 6 x 5 pixels, each pixel with other measurements.
class DecodeRecording : public testing::Test {
 protected:
  DecodeRecording() {
    raw_.frames = 3;
    raw_.height = 6;
    raw_.width = 5;
    raw_.measurements = 4;
    for (int i = 0; i < 3 * 6 * 5 * 4; ++i)
      raw_.values.push_back(1000.0F + static_cast<float>(i * 37 % 101));
    write_raw_frames(path("raw.npy"), raw_, OutputPolicy::refuse_existing);
  }
  std::filesystem::path path(const char* name) const { return directory_.path() / name; }
  DecodeRequest request(const char* output) const {
    return {.raw = path("raw.npy"), .output = path(output)};
  }

  TemporaryDirectory directory_;
  RawFrames raw_;
  Camera camera_ = built_in_camera("paper-10f0");
  AnyDecoder decoder_ =
      make_decoder(DecodeMethod::zncc, load_decoding_table("hamiltonian-k4", camera_).table);
};

TEST_F(DecodeRecording, GivesWhatTheDecoderGives) {
  const DecodedRecording result = decode_recording(request("d.npy"), decoder_);
  ASSERT_EQ(result.files.size(), 3u);
  EXPECT_EQ(result.frames.size(), 3u);
  EXPECT_EQ(result.total().pixels(), 3 * 6 * 5);
  EXPECT_EQ(result.outputs, std::vector{DecodedPlane::depth});
  for (int f = 0; f < 3; ++f) {
    RawFrames frame = raw_;
    frame.frames = 1;
    frame.values.assign(raw_.frame(f), raw_.frame(f) + 6 * 5 * 4);
    const DepthImage expected = std::get<Decoder>(decoder_).decode(frame);
    EXPECT_EQ(read_depth(result.files[static_cast<std::size_t>(f)]).pixels,
              expected.depth_m.pixels);
  }
}

TEST_F(DecodeRecording, TellsHowFarItCameWhenItIsStopped) {
  DecodedRecording result;
  const Progress progress = [](double fraction, std::string_view) { return fraction < 0.5; };
  EXPECT_THROW(decode_recording(request("d.npy"), decoder_, progress, result), Interrupted);
  EXPECT_EQ(result.frame_count, 3);
  EXPECT_EQ(result.frames.size(), 1u);
  ASSERT_EQ(result.files.size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(result.files.front()));
}

TEST_F(DecodeRecording, RefusesWhatCannotBeBeforeAnythingIsWritten) {
  const auto refused = [&](const DecodeRequest& wrong, const char* words) {
    EXPECT_THAT([&] { decode_recording(wrong, decoder_); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(words)));
  };
  DecodeRequest wrong = request("d.npz");
  wrong.frame = 3;
  refused(wrong, "frame = 3");
  wrong = request("d.npz");
  wrong.stack = true;
  refused(wrong, "stack = true");
  wrong = request("d.npz");
  wrong.outputs = {DecodedPlane::ratio};
  refused(wrong, "outputs = ratio");
  wrong = request("d.pfm");
  wrong.outputs = {DecodedPlane::signal};
  refused(wrong, "a .pfm file holds depth only");
  wrong = request("d.npz");
  wrong.memory_mb = 0.0;
  refused(wrong, "memory_mb = 0; must be > 0");
  wrong = request("raw.npy");
  wrong.frame = 0;
  wrong.policy = OutputPolicy::overwrite;
  EXPECT_THAT([&] { decode_recording(wrong, decoder_); },
              ThrowsMessage<IoError>(HasSubstr("choose another name")));
}

TEST(DecodedPlanes, HaveOneNameEach) {
  std::set<std::string_view> names;
  for (const DecodedPlane plane : all_decoded_planes) {
    names.insert(name_of(plane));
    EXPECT_EQ(parse_decoded_plane(name_of(plane)), plane);
  }
  EXPECT_EQ(names.size(), all_decoded_planes.size());
  EXPECT_THROW(parse_decoded_plane("depth_m"), std::invalid_argument);
  EXPECT_EQ(usual_planes().size(), 6u);
  EXPECT_EQ(usual_planes(true).size(), 9u);
}

TEST(LoadDecodingTable, GivesTablesOptionsToTablesOnly) {
  EXPECT_THAT(
      [] {
        load_decoding_table("hamiltonian-k3", built_in_camera("paper-10f0"), {.range_m = 3.0});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("range_m: goes with a measured table")));
}

}  // namespace
}  // namespace tofsmith

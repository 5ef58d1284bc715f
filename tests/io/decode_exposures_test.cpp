// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_directory.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two groups of three frames of 6 x 5 pixels.
class DecodeExposures : public testing::Test {
 protected:
  DecodeExposures() {
    raw_ = {.frames = 6, .height = 6, .width = 5, .measurements = 4, .values = {}};
    for (int i = 0; i < 6 * 6 * 5 * 4; ++i)
      raw_.values.push_back(1000.0F + static_cast<float>(i * 37 % 101));
    write_raw_frames(path("raw.npy"), raw_, OutputPolicy::refuse_existing);
    request_.raw = {path("raw.npy")};
    request_.output = path("hdr.npy");
    request_.hdr = {1.0, 2.0, 4.0};
    request_.stack = true;
  }
  std::filesystem::path path(const char* name) const { return directory_.path() / name; }

  TemporaryDirectory directory_;
  RawFrames raw_;
  DecodeRequest request_;
  std::unique_ptr<FrameBackend> backend_ = cpu_backend(
      make_decoder(DecodeMethod::zncc,
                   load_decoding_table("hamiltonian-k4", built_in_camera("paper-10f0")).table));
};

TEST_F(DecodeExposures, AreMergedLikeFramesInMemory) {
  request_.outputs = {DecodedPlane::depth, DecodedPlane::averaged};
  EXPECT_EQ(decode_recording(request_, *backend_).frames.size(), 2u);
  const Decoder& decoder = *backend_->decoder().correlation_decoder();
  std::vector<float> depth_m, averaged;
  for (int group = 0; group < 2; ++group) {
    std::vector<RawView> frames;
    for (int f = 0; f < 3; ++f)
      frames.push_back(RawView::interleaved(raw_.frame(3 * group + f), 6, 5, 4));
    MergedExposures merged;
    merge_exposures(frames, request_.hdr, decoder.table(), merged);
    Image<float> depth(6, 5);
    decoder.decode(merged.view(), {.depth_m = depth.pixels.data()});
    depth_m.insert(depth_m.end(), depth.pixels.begin(), depth.pixels.end());
    averaged.insert(averaged.end(), merged.averaged.pixels.begin(), merged.averaged.pixels.end());
  }
  EXPECT_EQ(read_npy(path("hdr.npy")).to_floats(), depth_m);
  EXPECT_EQ(read_npy(path("hdr-averaged.npy")).to_floats(), averaged);
}

TEST_F(DecodeExposures, RejectsInvalidGroups) {
  const auto refused = [&](const std::vector<double>& hdr, int average, const char* words) {
    request_.hdr = hdr;
    request_.average = average;
    EXPECT_THAT([&] { decode_recording(request_, *backend_); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(words)));
  };
  refused({1.0, 2.0, 4.0, 8.0}, 1, "hdr = 4 exposures");  // of six frames
  refused({2.0, 4.0, 8.0}, 1, "hdr = 2; must contain 1");
  refused({1.0, 2.0, 4.0}, 3, "average = 3; cannot be combined with hdr");
  EXPECT_FALSE(std::filesystem::exists(path("hdr.npy")));
}

}  // namespace
}  // namespace tofsmith

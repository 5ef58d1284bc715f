// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "decode_recording_fixture.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class OffsetNotes : public DecodeRecording {
 protected:
  /// Notes on a camera with a playback offset and an offset map of one value per column.
  std::vector<std::string> notes(double playback_m, std::vector<float> columns_m,
                                 double offset_m = 0.0) {
    camera_.playback = Playback{.offset_m = playback_m};
    const auto backend = cpu_backend(
        make_decoder(DecodeMethod::zncc, load_decoding_table("hamiltonian-k4", camera_).table));
    Image<float> map(6, 5);
    for (std::size_t i = 0; i < map.size(); ++i) map.pixels[i] = columns_m[i % 5];
    write_float_image(path("map.npy"), map, "offset", OutputPolicy::overwrite);
    DecodeRequest request = this->request("d.npz");
    request.policy = OutputPolicy::overwrite;
    request.offset_map = path("map.npy");
    request.offset_m = offset_m;
    return decode_recording(request, *backend).notes;
  }
};

TEST_F(OffsetNotes, ReportAConstantThatIsInTheMapAndInPlayback) {
  const auto sum = Contains(HasSubstr("their sum of 0.5 m is subtracted"));
  EXPECT_THAT(notes(0.25, {0.24F, 0.26F, 0.25F, 0.24F, 0.26F}), sum);
  EXPECT_THAT(notes(0.25, {0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, 0.25), sum);
}

TEST_F(OffsetNotes, AcceptAMapOfDifferencesBetweenPixels) {
  const auto both = Contains(HasSubstr("[playback]"));
  EXPECT_THAT(notes(0.25, {-0.02F, 0.01F, 0.03F, -0.01F, 0.0F}), Not(both));
  EXPECT_THAT(notes(0.0, {0.24F, 0.26F, 0.25F, 0.24F, 0.26F}), Not(both));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Notes of decode_recording() on raw numbers in the wrong order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "temporary_directory.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Misfit : public testing::Test {
 protected:
  /// Frames of a ramp of depths, (1, 24, 32, K).
  RawFrames recorded(const std::string& code, double signal_e_per_s = 1e6) const {
    SceneImage scene(24, 32);
    for (std::size_t i = 0; i < scene.depth_m.size(); ++i)
      scene.depth_m.pixels[i] = 1.0f + 0.009f * static_cast<float>(i);
    return capture(
        scene, load_code(code, camera_), camera_,
        {.signal_e_per_s = signal_e_per_s, .ambient_e_per_s = 1e4, .falloff = false, .seed = 3});
  }
  /// With measurement order[k] of each pixel as its k-th.
  static RawFrames in_order(RawFrames raw, const std::vector<int>& order) {
    const std::vector<float> before = raw.values;
    for (std::size_t pixel = 0; pixel < before.size(); pixel += order.size())
      for (std::size_t k = 0; k < order.size(); ++k)
        raw.values[pixel + k] = before[pixel + static_cast<std::size_t>(order[k])];
    return raw;
  }
  template <typename Number>
  std::vector<std::string> notes(const std::string& code, const RawFrames& raw) const {
    const std::vector<Number> numbers(raw.values.begin(), raw.values.end());
    const TemporaryDirectory directory;
    write_npy(directory / "raw.npy",
              NpyArray::of<Number>({24, 32, static_cast<std::size_t>(raw.measurements)}, numbers),
              OutputPolicy::overwrite);
    const auto backend =
        cpu_backend(make_decoder(DecodeMethod::zncc, load_decoding_table(code, camera_).table));
    return decode_recording({.raw = {directory / "raw.npy"}, .output = directory / "d.npz"},
                            *backend)
        .notes;
  }

  Camera camera_ = load_camera("paper-10f0");
};

TEST_F(Misfit, IsNotReportedForNumbersInTheRightOrder) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k5", "multifrequency-1x4-5x4"})
    for (const double signal : {1e3, 1e5, 1e7})
      EXPECT_THAT(notes<float>(code, recorded(code, signal)), IsEmpty()) << code << " " << signal;
}

TEST_F(Misfit, NamesAnOrderThatFits) {
  const RawFrames phases = in_order(recorded("sinusoid-k4"), {0, 2, 1, 3});
  EXPECT_THAT(notes<float>("sinusoid-k4", phases),
              ElementsAre(AllOf(HasSubstr("raw numbers do not fit this code (residual"),
                                HasSubstr("--order 0,2,1,3;"), HasSubstr("others"))));
  const RawFrames exchanged =
      in_order(recorded("multifrequency-1x4-5x4"), {4, 5, 6, 7, 0, 1, 2, 3});
  EXPECT_THAT(notes<float>("multifrequency-1x4-5x4", exchanged),
              ElementsAre(HasSubstr("--order 4,5,6,7,0,1,2,3")));
  const RawFrames nested = in_order(recorded("multifrequency-1x4-5x4"), {0, 4, 1, 5, 2, 6, 3, 7});
  EXPECT_THAT(notes<float>("multifrequency-1x4-5x4", nested),
              ElementsAre(HasSubstr("--order 0,4,1,5,2,6,3,7")));
}

TEST_F(Misfit, NamesTheByteOrder) {
  camera_ = load_camera("paper-10f0",
                        std::vector<std::string>{"sensor.adc_bits=16", "sensor.gain_e_per_dn=10"});
  RawFrames raw = recorded("hamiltonian-k4");
  EXPECT_THAT(notes<std::uint16_t>("hamiltonian-k4", raw), IsEmpty());
  for (float& number : raw.values) {
    const auto word = static_cast<std::uint16_t>(number);
    number = static_cast<float>(static_cast<std::uint16_t>(word << 8 | word >> 8));
  }
  EXPECT_THAT(notes<std::uint16_t>("hamiltonian-k4", raw),
              ElementsAre(HasSubstr("the other byte order")));
}

TEST_F(Misfit, NamesNoOrderForAnotherCode) {
  EXPECT_THAT(notes<float>("hamiltonian-k4", recorded("gray-k4")),
              ElementsAre(AllOf(HasSubstr("check --order, --code"), Not(HasSubstr("Better fit")))));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <vector>

#include "temporary_directory.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Three frames of 6 x 5 pixels with different measurements.
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
    return {.raw = {path("raw.npy")}, .output = path(output)};
  }
  std::vector<float> plane(const char* name, std::size_t frame) const {
    const NpyArray array = read_npy(path(name));
    const auto* const first = reinterpret_cast<const float*>(array.bytes().data()) + frame * 6 * 5;
    return {first, first + 6 * 5};
  }

  TemporaryDirectory directory_;
  RawFrames raw_;
  Camera camera_ = built_in_camera("paper-10f0");
  std::unique_ptr<FrameBackend> backend_ = cpu_backend(
      make_decoder(DecodeMethod::zncc, load_decoding_table("hamiltonian-k4", camera_).table));
};

}  // namespace tofsmith

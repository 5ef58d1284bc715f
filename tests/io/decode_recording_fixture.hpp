// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "temporary_directory.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

inline std::unique_ptr<FrameBackend> backend_of(const Camera& camera,
                                                const char* code = "hamiltonian-k4") {
  return cpu_backend(make_decoder(DecodeMethod::zncc, load_decoding_table(code, camera).table));
}

/// Returns a stream of `bytes` that counts the bytes read in `at`.
inline ReadStream stream_of(std::span<const std::byte> bytes, std::size_t& at) {
  return [bytes, &at](std::span<std::byte> into) {
    const std::size_t count = std::min(into.size(), bytes.size() - at);
    std::ranges::copy(bytes.subspan(at, count), into.begin());
    at += count;
    return count;
  };
}

/// Frames of 6 x 5 pixels with different measurements.
class DecodeRecording : public testing::Test {
 protected:
  explicit DecodeRecording(int frames = 3) {
    raw_ = {.frames = frames, .height = 6, .width = 5, .measurements = 4, .values = {}};
    for (int i = 0; i < frames * 6 * 5 * 4; ++i)
      raw_.values.push_back(1000.0F + static_cast<float>(i * 37 % 101));
    write_raw_frames(path("raw.npy"), raw_, OutputPolicy::refuse_existing);
  }
  std::filesystem::path path(const char* name) const { return directory_.path() / name; }
  DecodeRequest request(const char* output) const {
    return {.raw = {path("raw.npy")}, .output = path(output)};
  }
  /// One file per plane.
  DecodeRequest stack(const char* output, const std::vector<DecodedPlane>& planes) const {
    DecodeRequest request = this->request(output);
    request.stack = true;
    request.outputs = planes;
    return request;
  }
  std::vector<float> plane(const char* name, std::size_t frame) const {
    const NpyArray array = read_npy(path(name));
    const auto* const first = reinterpret_cast<const float*>(array.bytes().data()) + frame * 6 * 5;
    return {first, first + 6 * 5};
  }

  TemporaryDirectory directory_;
  RawFrames raw_;
  Camera camera_ = built_in_camera("paper-10f0");
  std::unique_ptr<FrameBackend> backend_ = backend_of(camera_);
};

}  // namespace tofsmith

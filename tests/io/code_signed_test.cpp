// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

Camera mixer_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.demodulation = Demodulation::weight;
  return camera;
}

CodeSet analog_code() {
  Eigen::MatrixXd weights(48, 3);
  for (int e = 0; e < 3; ++e)
    for (int n = 0; n < 48; ++n)
      weights(n, e) = std::sin(2 * std::numbers::pi * ((n + 0.5) / 48 - e / 3.0));
  return CodeSet::create_signed("analog", std::vector<Waveform>(3, rectangular_pulse(0.25)),
                                weights);
}

void expect_same_weights(const CodeSet& a, const CodeSet& b) {
  ASSERT_TRUE(a.is_signed());
  ASSERT_EQ(a.measurements(), b.measurements());
  for (int i = 0; i < a.measurements(); ++i)
    EXPECT_EQ(a.demodulation(i).is_binary(), b.demodulation(i).is_binary());
  EXPECT_LT((a.demodulation_samples() - b.demodulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((a.modulation_samples() - b.modulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SignedCodes, AreReadBackFromEveryFormat) {
  const TemporaryDirectory directory;
  Camera camera = mixer_camera();
  for (const CodeSet& code : {build_family("hamiltonian-k4", camera), analog_code()}) {
    camera.samples = code.samples();
    for (const char* name : {"a.code.json", "a.npz"}) {
      const std::string path = directory.path() / name;
      write_code(path, code, OutputPolicy::overwrite);
      expect_same_weights(load_code(path, camera), code);
    }
    const std::string csv = directory.path() / "a.csv";
    write_file_atomically(csv, waveforms_to_csv(code, 1e7), OutputPolicy::overwrite);
    const CodeSet read = load_code(csv, camera);
    EXPECT_TRUE(read.is_signed());
    EXPECT_LT((read.demodulation_samples() - code.demodulation_samples()).cwiseAbs().maxCoeff(),
              1e-8);
  }
}

TEST(SignedCodes, StoreTheirWeights) {
  const std::string json = code_to_json(analog_code());
  EXPECT_THAT(json, HasSubstr("\"signed\": true"));
  EXPECT_THAT(json, HasSubstr("-0.99"));
  EXPECT_EQ(code_to_json(parse_code_json(json, "a.code.json")), json);
}

std::string refusal(const std::string& json) {
  try {
    parse_code_json(json, "a.code.json");
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(SignedCodes, RejectInvalidWeights) {
  const std::string json = code_to_json(analog_code());
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string changed = json;
    const std::size_t at = changed.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return changed.replace(at, before.size(), after);
  };
  EXPECT_EQ(refusal(json), "");
  EXPECT_THAT(refusal(with("\"signed\": true", "\"signed\": true, \"rows\": true")),
              HasSubstr("is not valid for rows, whose weights are always signed"));
  EXPECT_THAT(refusal(with("\"taps\": 1", "\"taps\": 2")), HasSubstr("1 for a mixer"));
  EXPECT_NE(refusal(with("\"signed\": true", "\"signed\": false")), "");
  const std::string npz_path = "a.npz";
  const auto archive = serialize_code_npz(analog_code());
  EXPECT_THROW(parse_code_npz(archive, npz_path), IoError) << "gains are not negative";
  EXPECT_NO_THROW(parse_code_npz(archive, npz_path, {.is_signed = true}));
}

TEST(SignedCameras, AreReadAndWritten) {
  const Camera camera = mixer_camera();
  const std::string toml = camera_to_toml(camera);
  EXPECT_THAT(toml, HasSubstr("demodulation = \"signed\""));
  EXPECT_EQ(parse_camera_toml(toml, "a.toml"), camera);
}

}  // namespace
}  // namespace tofsmith

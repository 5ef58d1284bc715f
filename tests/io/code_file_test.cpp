// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "damaged_files.hpp"
#include "design_setup.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;

TEST(CodeFile, ReadingUndoesWritingByExtension) {
  const TemporaryDirectory directory;
  const CodeSet code = make_family("hamiltonian-k3", {.samples = 12}).with_two_buckets();
  write_code(directory / "a.code.json", code, OutputPolicy::refuse_existing);
  write_code(directory / "a.npz", code, OutputPolicy::refuse_existing, TapOrder::blocked);
  expect_same_code(read_code(directory / "a.code.json"), code);
  expect_same_samples(read_code(directory / "a.npz", {2, TapOrder::blocked}), code);
  EXPECT_THROW(
      write_code(directory / "a.npz", code, OutputPolicy::refuse_existing, TapOrder::blocked),
      IoError);
  EXPECT_THAT(io_error_of([&] { read_code(directory / "a.mat"); }),
              HasSubstr("expected one of .json, .npz"));
  EXPECT_THAT(io_error_of([&] { read_code(directory / "b.json"); }), HasSubstr("b.json"));
}

TEST(LoadCode, BuildsAFamilyForTheCamera) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  expect_same_code(load_code("hamiltonian-k4", camera), build_family("hamiltonian-k4", camera));
}

TEST(LoadCode, ReadsAFileWithTheTapsOfTheCamera) {
  const TemporaryDirectory directory;
  const std::string path = (directory / "a.npz").string();
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = make_family("square-k4", {}).with_two_buckets();
  write_code(path, code, OutputPolicy::refuse_existing, TapOrder::interleaved);
  EXPECT_EQ(load_code(path, camera).measurements(), 8);
  EXPECT_EQ(load_code(path, camera).taps(), 1);
  camera.sensor.taps = 2;
  EXPECT_THAT(io_error_of([&] { load_code(path, camera); }),
              HasSubstr("expected --tap-order blocked"));
  expect_same_samples(load_code(path, camera, {.tap_order = TapOrder::interleaved}), code);
}

struct ArrayPair {
  ArrayPair(const Eigen::MatrixXd& light, const Eigen::MatrixXd& gates) {
    write_npy(directory / "light.npy", array_of(light), OutputPolicy::overwrite);
    write_npy(directory / "gates.npy", array_of(gates), OutputPolicy::overwrite);
    name = (directory / "light.npy").string() + "," + (directory / "gates.npy").string();
  }
  std::string refusal(const Camera& camera) const {
    return io_error_of([&] { load_code(name, camera); });
  }

  TemporaryDirectory directory;
  std::string name;
};

TEST(LoadCode, ReadsPairsOfArraysOfAnyScaleAndOrientation) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = make_family("square-k4", {.samples = 24});
  const Eigen::MatrixXd light = code.modulation_samples(), gates = code.demodulation_samples();
  expect_same_samples(load_code(ArrayPair(light, gates).name, camera), code);
  expect_same_samples(
      load_code(ArrayPair(255 * light.transpose(), 255 * gates.transpose()).name, camera), code);
  // One light waveform for all exposures, and gates that open only partly.
  expect_same_samples(load_code(ArrayPair(light.col(0), gates).name, camera), code);
  const CodeSet half = load_code(ArrayPair(light, 0.5 * gates).name, camera);
  EXPECT_LT((half.demodulation_samples() - 0.5 * gates).norm(), 1e-12);
}

TEST(LoadCode, RejectsInvalidPairsOfArraysWithTheirPlace) {
  const Camera camera = built_in_camera("paper-10f0");
  Eigen::MatrixXd light = Eigen::MatrixXd::Ones(24, 3), gates = light;
  EXPECT_THAT(ArrayPair(0 * light, gates).refusal(camera),
              HasSubstr("light.npy: found only zeros; expected light"));
  EXPECT_THAT(ArrayPair(light, gates.topRows(23)).refusal(camera),
              HasSubstr("gates.npy: found the shape (23, 3); expected (24, 3) as of "));
  gates(5, 2) = -2.0;
  EXPECT_THAT(ArrayPair(light, gates).refusal(camera),
              HasSubstr("gates.npy[5, 2]: found -1; expected a gain in [0, 1]; signed weights "
                        "require a camera with sensor.readout"));
  light(7, 1) = -1.0;
  EXPECT_THAT(ArrayPair(light, gates).refusal(camera), HasSubstr("light.npy[7, 1]: found -1"));
}

TEST(LoadCode, SuggestsSimilarNames) {
  const Camera camera = built_in_camera("paper-10f0");
  EXPECT_EQ(io_error_of([&] { load_code("hamiltonain-k4", camera); }),
            "hamiltonain-k4: there is no such file and no built-in family of that name; did you "
            "mean hamiltonian-k4?");
  EXPECT_EQ(
      io_error_of([&] { load_code("my/own.code.json", camera); }),
      "my/own.code.json: there is no such file and no built-in family of that name; `tofsmith "
      "codes` lists them");
}

TEST(TapOrder, HasTwoValidNames) {
  EXPECT_EQ(parse_word<TapOrder>("tap order", "blocked"), TapOrder::blocked);
  EXPECT_EQ(parse_word<TapOrder>("tap order", "interleaved"), TapOrder::interleaved);
  EXPECT_THROW(parse_word<TapOrder>("tap order", "both"), std::invalid_argument);
}

TEST(CorrelationFile, AListIsOneFunction) {
  const TemporaryDirectory directory;
  const std::vector<float> column(10, 0.5f);
  write_npy(directory / "one.npy", NpyArray::of<float>({10}, column),
            OutputPolicy::refuse_existing);
  EXPECT_EQ(read_correlation_functions(directory / "one.npy"),
            Eigen::MatrixXd::Constant(10, 1, .5));
}

TEST(CorrelationFile, RejectsInvalidCorrelationFunctions) {
  const TemporaryDirectory directory;
  const auto refusal = [&](const char* name, const NpyArray& array) {
    if (std::filesystem::path(name).extension() == ".npy")
      write_npy(directory / name, array, OutputPolicy::overwrite);
    else
      write_npz(directory / name, {{"chi", array}}, OutputPolicy::overwrite);
    return io_error_of([&] { read_correlation_functions(directory / name); });
  };
  EXPECT_THAT(refusal("a.npy", NpyArray(NpyType::float64, {7, 2})),
              HasSubstr("a.npy: found 7 samples of the period; expected at least 8"));
  EXPECT_THAT(refusal("a.npy", NpyArray(NpyType::float64, {8, 0})), HasSubstr("expected (N, K)"));
  EXPECT_THAT(refusal("a.npy", NpyArray(NpyType::float64, {8, 1, 1})),
              HasSubstr("found the shape (8, 1, 1); expected (N, K)"));
  Eigen::MatrixXd infinite = Eigen::MatrixXd::Zero(8, 2);
  infinite(3, 1) = HUGE_VAL;
  EXPECT_THAT(refusal("a.npy", array_of(infinite)),
              HasSubstr("a.npy[3, 1]: found inf; expected a finite number"));
  EXPECT_THAT(refusal("a.npz", NpyArray(NpyType::float64, {8, 2})),
              HasSubstr("there is no array 'corrfs'; found chi"));
  EXPECT_THAT(io_error_of([&] { read_correlation_functions("a.exr"); }),
              HasSubstr("expected one of .csv, .txt, .tsv, .dat, .npy, .npz"));
}

using nlohmann::json;

/// One binary and one sampled waveform per tap, and values without a finite decimal representation.
CodeSet awkward_code() {
  Eigen::VectorXd light(4), gains(4);
  light << 1.0 / 3, 0.1, 0.0, 4 - 0.1 - 1.0 / 3;
  gains << 0.0, 1.0 / 7, 0.5, 5e-324;
  CodeSet code = CodeSet::create(
      "two \"taps\" \xc3\xa9", 4, 2,
      {Waveform::binary({{1.0 / 9, 0.3}, {0.9, 1.1}}, 2.0), Waveform::sampled(light)},
      {square_wave(1, 0.25), Waveform::constant(0.0), Waveform::sampled(gains),
       Waveform::sampled(0.5 * gains)});
  code.provenance = {"factorize", "my camera",    18446744073709551615ull,
                     "0.1.0",     {0.1, 1.0 / 3}, 0.02};
  return code;
}

json changed(const std::string& pointer, const json& value) {
  json document = json::parse(code_to_json(awkward_code()));
  document[json::json_pointer(pointer)] = value;
  return document;
}
json without(const std::string& parent, const std::string& member) {
  json document = json::parse(code_to_json(awkward_code()));
  document[json::json_pointer(parent)].erase(member);
  return document;
}
std::string refusal(const json& document) {
  return io_error_of([&] { parse_code_json(document.dump(), "c.json"); });
}

TEST(CodeJson, ReadingUndoesWriting) {
  expect_same_code(parse_code_json(code_to_json(awkward_code())), awkward_code());
  for (const FamilyDescription& family : list_families()) {
    const CodeSet code = make_family(family.example, {});
    expect_same_code(parse_code_json(code_to_json(code)), code);
  }
}

TEST(CodeJson, IsReadable) {
  const CodeSet code = CodeSet::create("k1", 8, 1, {rectangular_pulse(0.25)}, {square_wave(1, 0)});
  EXPECT_EQ(code_to_json(code), R"({
  "format": "tofsmith-code",
  "version": 1,
  "name": "k1",
  "samples": 8,
  "exposures": 1,
  "taps": 1,
  "modulation": [
    {"kind": "binary", "level": 4.0, "on": [[0.0, 0.25]]}
  ],
  "demodulation": [
    {"kind": "binary", "level": 1.0, "on": [[0.0, 0.5]]}
  ],
  "provenance": {
    "method": "",
    "camera": "",
    "seed": 0,
    "version": "",
    "residuals": [],
    "depth_error_m": 0.0
  }
}
)");
}

TEST(CodeJson, KeepsTheExposureSharesOfACode) {
  const std::vector<double> shares{0.4, 0.3, 0.2, 0.1};
  const CodeSet code = make_family("square-k4", {}).with_exposure_shares(shares);
  EXPECT_EQ(parse_code_json(code_to_json(code)).exposure_shares(), shares);
  nlohmann::json document = nlohmann::json::parse(code_to_json(code));
  document["exposure_shares"] = {0.5, 0.5, 0.5, 0.5};
  EXPECT_THAT(io_error_of([&] { parse_code_json(document.dump(), "c.json"); }),
              HasSubstr("sum of exposure_shares = 2; must be 1"));
}

TEST(CodeJson, ProvenanceIsOptional) {
  EXPECT_EQ(parse_code_json(without("", "provenance").dump()).provenance.method, "");
  const CodeSet code = parse_code_json(without("/provenance", "residuals").dump());
  EXPECT_EQ(code.provenance.method, "factorize");
  EXPECT_TRUE(code.provenance.residuals.empty());
}

struct BadMember {
  const char* pointer;
  json value;
  const char* message;
};

class CodeJsonRefuses : public testing::TestWithParam<BadMember> {};

TEST_P(CodeJsonRefuses, WithPointerAndWhatWasExpected) {
  EXPECT_EQ(refusal(changed(GetParam().pointer, GetParam().value)),
            std::string("c.json: ") + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Members, CodeJsonRefuses,
    testing::Values(
        BadMember{"/format", "other", "/format: found \"other\"; expected \"tofsmith-code\""},
        BadMember{"/version", 2, "/version: found 2; expected 1: a newer tofsmith wrote this file"},
        BadMember{"/samlpes", 4, "unknown member \"samlpes\"; did you mean \"samples\"?"},
        BadMember{"/name", 3, "/name: found 3; expected a text"},
        BadMember{"/samples", 4.0, "/samples: found 4.0; expected an integer in [2, 65536]"},
        BadMember{"/samples", 18446744073709551615ull,
                  "/samples: found 18446744073709551615; expected an integer in [2, 65536]"},
        BadMember{"/taps", 0, "/taps: found 0; expected an integer in [1, 32]"},
        BadMember{
            "/taps", 3,
            "/demodulation: found a list of 4; expected a list of 6: /exposures x /taps functions"},
        BadMember{
            "/exposures", 3,
            "/modulation: found a list of 2; expected a list of 3: as specified by /exposures"},
        BadMember{"/modulation", "none",
                  "/modulation: found \"none\"; expected a list of 2: as specified by /exposures"},
        BadMember{"/modulation/0", 3, "/modulation/0: found 3; expected an object"},
        BadMember{"/modulation/0/kind", "square",
                  "/modulation/0/kind: found \"square\"; expected \"binary\", \"sampled\" or "
                  "\"cosines\""},
        BadMember{"/modulation/0/levle", 1,
                  "/modulation/0: unknown member \"levle\"; did you mean \"level\"?"},
        BadMember{"/modulation/0/level", 0, "/modulation/0/level: found 0; expected a number > 0"},
        BadMember{"/modulation/0/level", 3,
                  "/modulation/0: modulation 0 mean = 1.16667; must be <= 1: modulation is power "
                  "over average power"},
        BadMember{"/modulation/0/on/1",
                  {0.25, 0.4},
                  "/modulation/0/on: on interval 0 = [0.1111111111111111, 0.3); switching times "
                  "must be sorted: the next rise is at 0.25"},
        BadMember{"/modulation/0/on/1",
                  {0.9, 0.9},
                  "/modulation/0/on: on interval 1 = [0.9, 0.9); must satisfy 0 <= rise < 1 and "
                  "rise < fall <= rise + 1"},
        BadMember{"/modulation/0/on/1/0", nullptr,
                  "/modulation/0/on/1/0: found null; expected a number"},
        BadMember{"/modulation/0/on/1",
                  {0.9},
                  "/modulation/0/on/1: found a list of 1; expected a list of 2: [rise, fall]"},
        BadMember{"/modulation/1/values/2", -0.5,
                  "/modulation/1/values/2: found -0.5; expected a number >= 0"},
        BadMember{"/modulation/1/values",
                  {1, 1, 1},
                  "/modulation/1/values: found a list of 3; expected a list of 4: as specified by "
                  "/samples"},
        BadMember{"/demodulation/0/level", 1.5,
                  "/demodulation/0/level: found 1.5; expected a number in [0, 1]"},
        BadMember{"/demodulation/2/values/3", 1.5,
                  "/demodulation/2/values/3: found 1.5; expected a number in [0, 1]"},
        BadMember{"/demodulation/3/values/2", 0.75,
                  "sum over taps of exposure 1 = 1.25; must be <= 1: each electron is collected by "
                  "one tap"},
        BadMember{"/provenance/sede", 3,
                  "/provenance: unknown member \"sede\"; did you mean \"seed\"?"},
        BadMember{"/provenance/seed", -1,
                  "/provenance/seed: found -1; expected an integer in [0, 2^64)"},
        BadMember{"/provenance/residuals/1", "x",
                  "/provenance/residuals/1: found \"x\"; expected a number"}));

TEST(CodeJson, RejectsMissingMembers) {
  EXPECT_EQ(refusal(without("", "samples")), "c.json: found no member \"samples\"; expected one");
  EXPECT_EQ(refusal(without("", "format")),
            "c.json: found no member \"format\"; expected \"format\": \"tofsmith-code\"");
  EXPECT_EQ(refusal(without("/demodulation/2", "values")),
            "c.json: /demodulation/2: found no member \"values\"; expected one");
  EXPECT_EQ(refusal(json(3)), "c.json: found 3; expected an object");
}

TEST(CodeJson, RejectsWritingInvalidCodes) {
  CodeSet code = awkward_code();
  code.provenance.depth_error_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(code_to_json(code), std::invalid_argument);
  EXPECT_THROW(code_to_json(awkward_code().renamed("\xff")), std::invalid_argument);
}

TEST(CodeJson, RejectsEveryTruncation) {
  std::string text = code_to_json(awkward_code());
  text.pop_back();  // every prefix of the text without the final line end is incomplete
  const auto parse = [](std::span<const std::byte> bytes) {
    parse_code_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "c.json");
  };
  expect_truncations_refused(bytes_of(text), parse);
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <locale>

#include "damaged_files.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "same_code.hpp"
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
  EXPECT_EQ(io_error_of([&] { load_code("hamiltonan-k3", camera); }),
            "hamiltonan-k3: there is no such file and no built-in family of that name; did you "
            "mean hamiltonian-k3?");
}

TEST(TapOrder, HasTwoValidNames) {
  EXPECT_EQ(parse_tap_order("blocked"), TapOrder::blocked);
  EXPECT_EQ(parse_tap_order("interleaved"), TapOrder::interleaved);
  EXPECT_THROW(parse_tap_order("both"), std::invalid_argument);
}

TEST(CorrelationFile, IsReadFromEveryFormat) {
  const TemporaryDirectory directory;
  Eigen::MatrixXd functions = Eigen::MatrixXd::NullaryExpr(
      8, 2, [](Eigen::Index n, Eigen::Index i) { return static_cast<double>(n * 2 + i) / 16; });
  std::ofstream csv(directory / "f.csv");
  csv.imbue(std::locale::classic());
  csv << "chi_0,chi_1\n";
  for (Eigen::Index n = 0; n < 8; ++n) csv << functions(n, 0) << "," << functions(n, 1) << "\n";
  csv.close();
  write_npy(directory / "f.npy", array_of(functions), OutputPolicy::refuse_existing);
  write_npz(directory / "f.npz", {{"corrfs", array_of(functions)}}, OutputPolicy::refuse_existing);
  for (const char* name : {"f.csv", "f.npy", "f.npz"})
    EXPECT_EQ(read_correlation_functions(directory / name), functions) << name;

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

TEST(PublishedCodes, AllLoadAndCorrelateLikeTheirFiles) {
  const std::filesystem::path directory =
      std::filesystem::path(TOFSMITH_SOURCE_DIR) / "../shared/data/itof_codes";
  if (!std::filesystem::exists(directory)) GTEST_SKIP() << "no published codes beside the source";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() != ".npz") continue;
    SCOPED_TRACE(entry.path().filename());
    ++files;
    const bool complementary = entry.path().string().find("complementary") != std::string::npos;
    const TapLayout layout = {complementary ? 2 : 1, TapOrder::blocked};
    const CodeSet code = read_code(entry.path(), layout);
    for (int e = 0; e < code.exposures(); ++e) EXPECT_TRUE(code.modulation(e).is_binary());
    const NpzArrays ours =
        parse_npz(serialize_code_npz(code, TapOrder::blocked), entry.path().string());
    const NpzArrays theirs = read_npz(entry.path());
    for (const char* name : {"modfs", "demodfs", "corrfs"})
      EXPECT_LT(
          (matrix_of(ours.at(name), name) - matrix_of(theirs.at(name), name)).cwiseAbs().maxCoeff(),
          1e-9)
          << name;
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace tofsmith

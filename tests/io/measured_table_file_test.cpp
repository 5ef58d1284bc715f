// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <locale>

#include "damaged_files.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Arbitrary, partly negative functions without repetition.
Eigen::MatrixXd sweep(Eigen::Index samples, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(samples, columns, [&](Eigen::Index n, Eigen::Index k) {
    return std::cos(2 * M_PI * (double(n) / double(samples) - double(k) / double(columns))) + 0.1;
  });
}

Eigen::MatrixXd closed(const Eigen::MatrixXd& functions) {
  Eigen::MatrixXd longer(functions.rows() + 1, functions.cols());
  longer << functions, functions.row(0);
  return longer;
}

NpyArray list(const std::vector<double>& values) {
  return NpyArray::of<double>({values.size()}, values);
}

class MeasuredTableFileTest : public testing::Test {
 protected:
  MeasuredTableFile read(const Eigen::MatrixXd& functions,
                         const MeasuredTableOptions& options = {}) {
    return read(NpzArrays{{"corrfs", array_of(functions)}}, options);
  }
  MeasuredTableFile read(const NpzArrays& arrays, const MeasuredTableOptions& options = {}) {
    write_npz(path(), arrays, OutputPolicy::overwrite);
    return read_measured_table(path(), options);
  }
  template <typename Content>
  std::string refusal(const Content& content, const MeasuredTableOptions& options = {}) {
    const std::string message = io_error_of([&] { read(content, options); });
    EXPECT_THAT(message, HasSubstr(path().string()));
    return message.substr(std::min(message.size(), path().string().size()));
  }
  static std::vector<std::string> without_name(const MeasuredTableFile& file) {
    std::vector<std::string> notes;
    for (const std::string& note : file.notes) notes.push_back(note.substr(note.find("npz: ") + 5));
    return notes;
  }

  std::filesystem::path path() const { return directory_ / "t.npz"; }
  TemporaryDirectory directory_;
};

TEST_F(MeasuredTableFileTest, IsIndependentOfFormatAndLength) {
  for (const Eigen::Index samples : {8, 61, 1939}) {
    const Eigen::MatrixXd functions = sweep(samples, 4);
    std::ofstream csv(directory_ / "t.csv");
    csv.imbue(std::locale::classic());
    csv.precision(17);
    csv << functions << "\n";
    csv.close();
    write_npy(directory_ / "t.npy", array_of(functions), OutputPolicy::overwrite);
    EXPECT_EQ(read(functions).table.correlation, functions);
    EXPECT_EQ(read_measured_table(directory_ / "t.csv").table.correlation, functions);
    EXPECT_EQ(read_measured_table(directory_ / "t.npy").table.correlation, functions);
    EXPECT_THAT(read(functions).notes, IsEmpty());
  }
}

TEST_F(MeasuredTableFileTest, OmitsAFirstColumnOfSampleNumbersOrTimes) {
  const Eigen::MatrixXd functions = sweep(10, 4);
  Eigen::MatrixXd counted(10, 5);
  counted << Eigen::VectorXd::LinSpaced(10, 0.0, 9.0), functions;
  const Eigen::IOFormat format(17, Eigen::DontAlignCols, ";", "\n", "", "", "", "\n");
  for (const char* name : {"t.csv", "T.CSV", "t.txt", "t.tsv", "t.dat"})
    for (const char* first_column : {"", "n;", "time (ns);"}) {
      std::ofstream file(directory_ / name);
      file.imbue(std::locale::classic());
      file << first_column << "p0;p90;p180;p270\n";
      file << (*first_column == '\0' ? functions : counted).format(format);
      file.close();
      EXPECT_TRUE(is_measured_table(directory_ / name));
      EXPECT_EQ(read_measured_table(directory_ / name).table.correlation, functions);
    }
}

TEST_F(MeasuredTableFileTest, DistinguishesCodesFromTables) {
  const NpyArray functions = array_of(sweep(20, 3));
  const auto is_table = [&](const NpzArrays& arrays) {
    write_npz(path(), arrays, OutputPolicy::overwrite);
    return is_measured_table(path());
  };
  EXPECT_TRUE(is_table({{"corrfs", functions}}));
  EXPECT_FALSE(is_table({{"corrfs", functions}, {"modfs", functions}, {"demodfs", functions}}));
  EXPECT_FALSE(is_table({{"corrfs", functions}, {"modfs", functions}}));
  EXPECT_FALSE(is_table({{"chi", functions}}));
  EXPECT_TRUE(is_measured_table("x.CSV"));
  EXPECT_TRUE(is_measured_table("x.npy"));
  EXPECT_FALSE(is_measured_table("x.code.json"));
  EXPECT_FALSE(is_measured_table("hamiltonian-k3"));
}

TEST_F(MeasuredTableFileTest, DropsARepeatedEndPointWithANote) {
  const Eigen::MatrixXd functions = sweep(50, 3);
  Eigen::MatrixXd longer = closed(functions);
  longer(50, 1) += 1e-7;  // rounding error of single precision
  const MeasuredTableFile dropped = read(longer);
  EXPECT_EQ(dropped.table.correlation, functions);
  EXPECT_THAT(
      without_name(dropped),
      ElementsAre(
          "its last sample repeats the first and was dropped: N = 50, which makes depths 2 % "
          "larger (--keep-end-point keeps it)"));
  EXPECT_EQ(read(longer, {.keep_end_point = true}).table.samples(), 51);
  longer(50, 1) += 1e-3;
  EXPECT_EQ(read(longer).table.samples(), 51);
  EXPECT_THAT(read(longer).notes, IsEmpty());
}

TEST_F(MeasuredTableFileTest, KeepsAnEndPointOnAPlateau) {
  Eigen::MatrixXd functions = closed(sweep(50, 3));
  functions.row(49) = functions.row(50);
  const MeasuredTableFile kept = read(functions);
  EXPECT_EQ(kept.table.samples(), 51);
  EXPECT_THAT(without_name(kept), ElementsAre("its last sample equals the first, but so do their "
                                              "neighbours: all 51 were kept"));
}

TEST_F(MeasuredTableFileTest, UsesTheTransposedOrientationIfItIsTheOnlyValidOne) {
  const Eigen::MatrixXd functions = sweep(1939, 6);
  const MeasuredTableFile lying = read(functions.transpose().eval());
  EXPECT_EQ(lying.table.correlation, functions);
  EXPECT_THAT(
      without_name(lying),
      ElementsAre("its shape (6, 1939) was interpreted as (K, N): 6 measurements of 1939 samples"));
  // As (N, K) there would be too few samples or too many measurements.
  EXPECT_EQ(read(sweep(20, 7).transpose().eval()).table.samples(), 20);
  EXPECT_EQ(read(sweep(100, 12).transpose().eval()).table.samples(), 100);
}

TEST_F(MeasuredTableFileTest, NeverGuessesTheOrientation) {
  const Eigen::MatrixXd lying = sweep(64, 10).transpose();
  EXPECT_EQ(refusal(lying),
            ": found the shape (10, 64), which could be (N, K) or (K, N); expected the axes, "
            "--table-axes nk or kn");
  EXPECT_THAT(refusal(sweep(16, 16)), HasSubstr("could be (N, K) or (K, N)"));
  EXPECT_EQ(read(lying, {.axes = TableAxes::measurements_first}).table.samples(), 64);
  EXPECT_EQ(read(lying, {.axes = TableAxes::samples_first}).table.samples(), 10);
  EXPECT_THAT(read(lying, {.axes = TableAxes::measurements_first}).notes, IsEmpty());
  EXPECT_EQ(read(sweep(64, 10)).table.samples(), 64);
  EXPECT_EQ(refusal(sweep(1939, 6), {.axes = TableAxes::measurements_first}),
            ": found the shape (1939, 6); expected (K, N) with N in [8, 65536] and K at most 64");
  EXPECT_EQ(parse_table_axes("nk"), TableAxes::samples_first);
  EXPECT_EQ(parse_table_axes("kn"), TableAxes::measurements_first);
  EXPECT_THROW(parse_table_axes("hw"), std::invalid_argument);
}

TEST_F(MeasuredTableFileTest, GroupsTheTapsOfEachExposure) {
  const Eigen::MatrixXd functions = sweep(40, 6);
  const NpzArrays arrays = {{"corrfs", array_of(functions)},
                            {"ambient", list({0.0, 0.1, 0.2, 0.3, 0.4, 0.5})}};
  EXPECT_EQ(read(arrays, {.layout = {2, TapOrder::interleaved}}).table.correlation, functions);
  const MeasuredTable blocked = read(arrays, {.layout = {2, TapOrder::blocked}}).table;
  EXPECT_EQ(blocked.taps, 2);
  const int source[] = {0, 3, 1, 4, 2, 5};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(blocked.correlation.col(i), functions.col(source[i])) << i;
    EXPECT_DOUBLE_EQ(blocked.ambient_gain[i], 0.1 * source[i]);
  }
  EXPECT_THAT(refusal(functions, {.layout = {2, std::nullopt}}),
              AllOf(HasSubstr("--tap-order blocked"), HasSubstr("differences = 1")));
  EXPECT_THAT(refusal(functions, {.layout = {4, TapOrder::blocked}}),
              HasSubstr("multiple of taps"));
}

TEST_F(MeasuredTableFileTest, ReadsOptionalDataOfEveryColumn) {
  const MeasuredTableFile file = read({{"corrfs", array_of(sweep(40, 3))},
                                       {"ambient", list({0.5, 0.4, 0.3})},
                                       {"exposure_s", list({0.1, 0.2, 0.3})},
                                       {"offset_dn", list({10, -20, 30})},
                                       {"gain_e_per_dn", list({1, 2, 3})},
                                       {"gain", list({1, 2, 3})},
                                       {"serial", list({7})}});
  EXPECT_EQ(file.table.ambient_gain, Eigen::Vector3d(0.5, 0.4, 0.3));
  EXPECT_EQ(file.table.exposure_s, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(file.table.black_level, Eigen::Vector3d(10, -20, 30));
  EXPECT_EQ(file.table.gain_e_per_raw, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(without_name(file), ElementsAre("not used: gain, serial"));
  const MeasuredTable bare = read(sweep(40, 3)).table;
  EXPECT_EQ(bare.ambient_gain.size() + bare.exposure_s.size() + bare.black_level.size() +
                bare.gain_e_per_raw.size(),
            0);
}

TEST_F(MeasuredTableFileTest, RejectsInvalidFilesByName) {
  EXPECT_EQ(refusal(sweep(7, 3)),
            ": found the shape (7, 3); expected (N, K) with N in [8, 65536] and K at most 64");
  EXPECT_THAT(refusal(sweep(80, 70)), HasSubstr("K at most 64"));
  EXPECT_THAT(refusal(closed(sweep(7, 3))),
              HasSubstr("found 7 samples and a repeated end point; expected at least 8"));
  Eigen::MatrixXd functions = sweep(20, 3);
  functions(4, 1) = std::nan("");
  EXPECT_EQ(refusal(functions), ": corrfs[4, 1]: found nan; expected a finite number");
  const auto with = [](const char* name, const NpyArray& array) {
    return NpzArrays{{"corrfs", array_of(sweep(20, 3))}, {name, array}};
  };
  EXPECT_EQ(refusal(with("ambient", list({1, 2}))),
            ": ambient: found the shape (2,); expected (3,), one number per column of corrfs");
  EXPECT_EQ(refusal(with("offset_dn", list({1, HUGE_VAL, 2}))),
            ": offset_dn[1]: found inf; expected a finite number");
  EXPECT_THAT(refusal(with("exposure_s", array_of(sweep(3, 3)))), HasSubstr("shape (3, 3)"));
  EXPECT_THAT(refusal(NpzArrays{{"chi", array_of(sweep(20, 3))}}),
              HasSubstr("there is no array 'corrfs'; found chi"));
}

}  // namespace
}  // namespace tofsmith

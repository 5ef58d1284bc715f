// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Csv, ReadsNumbersBetweenAnySeparators) {
  const CsvTable table =
      parse_csv("# measured\n a , b\n1,2\n\n3; -4.5e-3\r\n+5\t6\n7   8", "t.csv");
  EXPECT_THAT(table.names, ElementsAre("a", "b"));
  Eigen::MatrixXd expected(4, 2);
  expected << 1, 2, 3, -4.5e-3, 5, 6, 7, 8;
  EXPECT_EQ(table.values, expected);
  EXPECT_TRUE(parse_csv("1 2\n", "t.csv").names.empty());
}

TEST(Csv, SaysWhereItFoundNoNumber) {
  const auto refusal = [](const char* text) {
    return io_error_of([&] { parse_csv(text, "t.csv"); });
  };
  EXPECT_EQ(refusal("1,2\n3, x4\n"), "t.csv:2:4: found 'x4'; expected a finite number");
  EXPECT_EQ(refusal("1,2\n3,nan\n"), "t.csv:2:3: found 'nan'; expected a finite number");
  EXPECT_EQ(refusal("1,2\n3,1e999\n"), "t.csv:2:3: found '1e999'; expected a finite number");
  EXPECT_EQ(refusal("1,2\n3,\n"), "t.csv:2:3: found ''; expected a finite number");
  EXPECT_EQ(refusal("1,,2\n"), "t.csv:1:3: found ''; expected a finite number");
  EXPECT_EQ(refusal("a,b\na,b\n"), "t.csv:2:1: found 'a'; expected a finite number");
  EXPECT_EQ(refusal("a,b\n1\n"), "t.csv:2:1: found 1 columns; expected 2 as in the first row");
  EXPECT_EQ(refusal("a,b\n"), "t.csv: found no row of numbers; expected at least one");
}

class ResponseFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name) << text;
    return directory_ / name;
  }
  std::string refusal(const std::string& text, std::optional<double> time_step_s) const {
    return io_error_of([&] { read_impulse_response(write("r.csv", text), time_step_s); });
  }
  TemporaryDirectory directory_;
};

TEST_F(ResponseFile, TimesTellTheStep) {
  const auto path = write("r.csv", "time_s,value\n5e-9,1\n6e-9,3\n7e-9,0.5\n");
  const ImpulseResponse response = read_impulse_response(path);
  EXPECT_EQ(response.kind, ImpulseResponse::Kind::file);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 3.0, 0.5));
  EXPECT_NEAR(response.time_step_s, 1e-9, 1e-15);
  EXPECT_EQ(response.file, path.string());
  EXPECT_EQ(read_impulse_response(path, 1e-9).time_step_s, 1e-9);
}

TEST_F(ResponseFile, ValuesAloneNeedAStep) {
  EXPECT_THAT(read_impulse_response(write("r.txt", "1\n2\n"), 2e-9).samples, ElementsAre(1.0, 2.0));
  write_npy(directory_ / "r.npy", NpyArray::of<float>({3}, std::vector<float>{1, 2, 4}),
            OutputPolicy::overwrite);
  const ImpulseResponse response = read_impulse_response(directory_ / "r.npy", 2e-9);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 2.0, 4.0));
  EXPECT_EQ(response.time_step_s, 2e-9);
  EXPECT_THAT(refusal("1\n2\n", std::nullopt), HasSubstr("expected time_step_s"));
}

TEST_F(ResponseFile, RefusesWhatIsNoResponse) {
  EXPECT_THAT(refusal("0,1\n1e-9,2\n3e-9,1\n", {}),
              HasSubstr("row 1: found the time 1e-09 s; expected 1.5e-09 s"));
  EXPECT_THAT(refusal("2e-9,1\n1e-9,2\n", {}), HasSubstr("do not rise"));
  EXPECT_THAT(refusal("0,1\n", {}), HasSubstr("found one time"));
  EXPECT_THAT(refusal("1,2,3\n", 1e-9), HasSubstr("found 3 columns"));
  EXPECT_THAT(refusal("value,time_s\n1,0\n1,1\n", {}), HasSubstr("found a first column value"));
  EXPECT_THAT(refusal("0,1\n1e-9,2\n", 2e-9), HasSubstr("expected time_step_s = 2e-09"));
  EXPECT_THAT(refusal("1\n-1\n", 1e-9), HasSubstr("samples sum = 0; must be > 0"));
  EXPECT_THAT(refusal("1\n", -1.0), HasSubstr("time_step_s = -1; must be finite and > 0"));
  EXPECT_THAT(io_error_of([&] { read_impulse_response("r.png", 1e-9); }),
              HasSubstr("expected one of .csv, .txt, .npy"));
  write_npy(directory_ / "r.npy", NpyArray(NpyType::float64, {3, 2}), OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_impulse_response(directory_ / "r.npy", 1e-9); }),
              HasSubstr("found an array of shape (3, 2); expected one axis"));
}

}  // namespace
}  // namespace tofsmith

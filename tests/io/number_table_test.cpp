// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/number_table.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Eigen::MatrixXd two_rows() {
  Eigen::MatrixXd expected(2, 2);
  expected << 0.5, -1.25, 1.5, 3e-3;
  return expected;
}

std::string refusal(const std::string& text, const NumberTableOptions& options = {}) {
  return io_error_of([&] { parse_number_table(text, "t.csv", options); });
}

TEST(NumberTable, IsIndependentOfTheDialect) {
  for (const char* text : {"0.5,-1.25\n1.5,3e-3\n",
                           "0.5;-1.25\n1.5;3e-3\n",
                           "0.5\t-1.25\r\n1.5\t3e-3\r\n",
                           "0.5   -1.25\n1.5 3e-3",
                           " 0.5 , -1.25\n1.5, 3e-3\n",
                           "+0.5,-1.25\r1.5,3e-3\r",
                           "0,5;-1,25\n1,5;3e-3\n",
                           "0,5\t-1,25\n1,5\t3e-3\n",
                           "0,5 -1,25\n1,5 3e-3\n",
                           "\"0.5\",\"-1.25\"\n1.5,3e-3\n",
                           "\"0,5\",\"-1,25\"\n\"1,5\",\"3e-3\"\n",
                           "\"0.5\" \"-1.25\"\n1.5 3e-3\n",
                           "0.5,-1.25,,\n1.5,3e-3,\n",
                           ",0.5,-1.25\n,1.5,3e-3\n",
                           "\xef\xbb\xbf# of a bench\n0.5,-1.25\n\n1.5,3e-3\n",
                           "a,b\n0.5,-1.25\n1.5,3e-3\n",
                           "a,b,step\ns,V,1e-9\n0.5,-1.25,\n1.5,3e-3,\n",
                           "a,b,,\n,,,\n0.5,-1.25,,\n1.5,3e-3,,\n,,,\n",
                           "Model,DSO,,0.5,-1.25,\n,,,1.5,3e-3,\n",
                           "Modell;DSO;;0,5;-1,25;\n;;;1,5;3e-3;\n"})
    EXPECT_EQ(parse_number_table(text, "t.csv").values, two_rows()) << text;
}

TEST(NumberTable, IsReadFromUtf16) {
  const TemporaryDirectory directory;
  for (const bool is_little : {true, false}) {
    std::string bytes;
    for (const char c : std::string("0,5;-1,25\n1,5;3e-3\n")) {
      bytes += is_little ? std::string{c, '\0'} : std::string{'\0', c};
    }
    std::ofstream(directory / "t.csv", std::ios::binary)
        << (is_little ? "\xff\xfe" : "\xfe\xff") << bytes;
    EXPECT_EQ(read_number_table(directory / "t.csv").values, two_rows());
  }
}

TEST(NumberTable, HasTheColumnNamesAboveTheNumbers) {
  const NumberTable table = parse_number_table(
      "Model,DSO-X\nRecord Length,2\n# kept apart\nTime (ns),Ch 1\n0.5,-1.25\n1.5,3e-3\n", "t.csv");
  EXPECT_THAT(table.names, ElementsAre("Time (ns)", "Ch 1"));
  EXPECT_EQ(table.values, two_rows());
  EXPECT_THAT(table.lines, ElementsAre(5u, 6u));
  EXPECT_THAT(table.notes, ElementsAre(HasSubstr("1 line of text")));
  const NumberTable numbered = parse_number_table("x-axis,1\ns,V\n0.5,-1.25\n1.5,3e-3\n", "t.csv");
  EXPECT_THAT(numbered.upper_names, ElementsAre("x-axis", "1"));
  EXPECT_THAT(numbered.notes, IsEmpty());
}

TEST(NumberTable, FindsColumnsByNameUnitAndNumber) {
  const NumberTable table =
      parse_number_table("X,CH1 (V),CH2,CH20,s\ns,V,A,A,C\n1,2,3,4,5\n3,4,5,6,7\n", "t.csv");
  const auto column = [&](const char* name) { return table.column_of(name, "t.csv"); };
  EXPECT_EQ(column("CH1 (V)"), 1);
  EXPECT_EQ(column("ch1"), 1);
  EXPECT_EQ(column("CH2"), 2);
  EXPECT_EQ(column("5"), 4);
  EXPECT_THAT(io_error_of([&] { column("A"); }), HasSubstr("more than one column A"));
  EXPECT_THAT(io_error_of([&] { column("6"); }), HasSubstr("no column 6 among 5 columns (X s,"));
  const NumberTable shifted = parse_number_table("Model,DSO,,1,2\n,,,3,4\n,,,5,6\n", "t.csv");
  EXPECT_EQ(shifted.column_of("5", "t.csv"), 1);  // columns are counted in the file
}

TEST(NumberTable, AmbiguousCommasAreResolvedOrRejected) {
  EXPECT_EQ(parse_number_table("0,5\n1,7\n2,4\n", "t.csv").values.cols(), 2);  // first column rises
  EXPECT_EQ(parse_number_table("a,b\n4,5\n1,7\n", "t.csv").values.cols(), 2);
  EXPECT_EQ(parse_number_table("a\n4,5\n1,7\n", "t.csv").values(0, 0), 4.5);
  EXPECT_EQ(parse_number_table("4,5\n1,05\n", "t.csv").values(1, 0), 1.05);
  EXPECT_THAT(refusal("4,5\n1,7\n"), HasSubstr("t.csv:1:1: found '4,5', which can be 2 columns"));
  EXPECT_THAT(refusal("4,50,1,25\n1,75,2,05\n"),
              HasSubstr("t.csv:2:8: found '1,75,2,05', which has both decimal commas"));
  EXPECT_EQ(parse_number_table("4,1e-05,001\n1.5,2,002\n", "t.csv").values(1, 2), 2.0);
  const auto value = [](const NumberTableOptions& options) {
    return parse_number_table("4,5\n1,7\n", "t.csv", options).values(1, 0);
  };
  EXPECT_EQ(value({.decimal = DecimalMark::comma}), 1.7);
  EXPECT_EQ(value({.decimal = DecimalMark::point}), 1.0);
  EXPECT_EQ(value({.max_columns = 1}), 1.7);
  EXPECT_EQ(value({.min_columns = 2}), 1.0);
}

TEST(NumberTable, ReportsThePlaceOfOtherContent) {
  EXPECT_EQ(refusal("t,v\n1.5,2\n2.5,nan\n"),
            "t.csv:3:5: found 'nan' in column 2; expected a finite number");
  EXPECT_EQ(refusal("1.5,2\n2.5, x4\n"),
            "t.csv:2:6: found 'x4' in column 2; expected a finite number");
  EXPECT_EQ(refusal("1,x\n2.5,3\n4.5,3\n"),
            "t.csv:1:3: found 'x' in column 2; expected a finite number");
  EXPECT_EQ(refusal("1.5,2\n2.5\n"), "t.csv:2:1: found 1 columns; expected 2 as in line 1");
  EXPECT_EQ(refusal("1.5\n2.5,3\n2.5,3\n"), "t.csv:1:1: found 1 columns; expected 2 as in line 2");
  EXPECT_EQ(refusal("1.5,2,3\n2.5,,3\n"),
            "t.csv:2:5: found '' in column 2; expected a finite number");
  EXPECT_EQ(refusal("a,b\n"), "t.csv: found no row of numbers; expected at least one");
  EXPECT_EQ(refusal(""), "t.csv: found no row of numbers; expected at least one");
  EXPECT_THAT(refusal("1e999;2\n"), HasSubstr("t.csv:1:1: found '1e999' in column 1"));
  EXPECT_THAT(refusal("5,1\nno data\n"), HasSubstr("t.csv:2:1: found 'no data' in column 1"));
}

TEST(NumberTable, RejectsTheScpiValuesOfInfinityAndNaN) {
  for (const char* code : {"9.9E+37", "-9.9E+37", "9.91E+37", "9.90000e37", "9.8999995e+37"})
    EXPECT_THAT(refusal(fmt::format("s,V\n1,2\n3,{}\n", code)),
                HasSubstr(fmt::format("t.csv:3:3: found '{}' in column 2; expected a finite "
                                      "number (SCPI",
                                      code)));
  EXPECT_EQ(parse_number_table("9.8e37\n", "t.csv").values(0, 0), 9.8e37);
}

TEST(NumberTable, OneColumnIsRequiredOnRequest) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "c.txt") << "20,5\n21,5\n";
  EXPECT_EQ(read_number_column(directory / "c.txt", "the temperatures").values(1, 0), 21.5);
  std::ofstream(directory / "c.txt") << "frame;degrees\n1;20,5\n2;21,5\n";
  EXPECT_EQ(read_number_column(directory / "c.txt", "the temperatures").values(1, 0), 21.5);
  std::ofstream(directory / "c.txt") << "20.5,1\n21.5,2\n";
  EXPECT_THAT(io_error_of([&] { read_number_column(directory / "c.txt", "the temperatures"); }),
              HasSubstr("found 2 columns; expected one column, the temperatures"));
}

TEST(NumberTable, RecognizesUnitsOfTime) {
  EXPECT_EQ(seconds_per_unit("time_ns"), 1e-9);
  EXPECT_EQ(seconds_per_unit("Time (us)"), 1e-6);
  EXPECT_EQ(seconds_per_unit("Time (\xc2\xb5s)"), 1e-6);
  EXPECT_EQ(seconds_per_unit("Time (\xb5s)"), 1e-6);  // Latin-1
  EXPECT_EQ(seconds_per_unit("delay [ps]"), 1e-12);
  EXPECT_EQ(seconds_per_unit("Second"), 1.0);
  EXPECT_EQ(seconds_per_unit("Volts"), 0.0);
  EXPECT_EQ(seconds_per_unit("ch1s"), 0.0);
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

TEST_F(ResponseFile, TimesDetermineTheStep) {
  const auto path = write("r.csv", "time_s,value\n5e-9,1\n6e-9,3\n7e-9,0.5\n");
  const ImpulseResponse response = read_impulse_response(path);
  EXPECT_EQ(response.kind, ImpulseResponse::Kind::file);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 3.0, 0.5));
  EXPECT_NEAR(response.time_step_s, 1e-9, 1e-15);
  EXPECT_EQ(response.file, path.string());
  EXPECT_EQ(read_impulse_response(path, 1e-9).time_step_s, 1e-9);
}

TEST_F(ResponseFile, ReadsOscilloscopeFiles) {
  const std::vector<double> expected = {1.0, 3.0, 0.5};
  for (const char* text : {"Model,DSO,,5e-9,1,\n,,,6e-9,3,\n,,,7e-9,0.5,\n",
                           "\xef\xbb\xbftime_ns;V\n5;1\n6;3\n7;0,5\n",
                           "X,CH1,Increment\nSequence,Volt,1e-9\n0,1,\n1,3,\n2,0.5,\n",
                           "V,time_s\n1,5e-9\n3,6e-9\n0.5,7e-9\n"}) {
    const ImpulseResponse response = read_impulse_response(write("r.csv", text));
    EXPECT_EQ(response.samples, expected) << text;
    EXPECT_NEAR(response.time_step_s, 1e-9, 1e-15) << text;
  }
  EXPECT_EQ(read_impulse_response(write("r.csv", "0,1\n1,3\n2,0.5\n"), 2e-9).samples, expected);
}

TEST_F(ResponseFile, ValuesWithoutTimesNeedAStep) {
  EXPECT_THAT(read_impulse_response(write("r.txt", "1\n2\n"), 2e-9).samples, ElementsAre(1.0, 2.0));
  write_npy(directory_ / "r.npy", NpyArray::of<float>({3}, std::vector<float>{1, 2, 4}),
            OutputPolicy::overwrite);
  const ImpulseResponse response = read_impulse_response(directory_ / "r.npy", 2e-9);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 2.0, 4.0));
  EXPECT_EQ(response.time_step_s, 2e-9);
  EXPECT_THAT(refusal("1\n2\n", std::nullopt), HasSubstr("expected time_step_s"));
}

TEST_F(ResponseFile, RejectsInvalidResponses) {
  EXPECT_THAT(refusal("0,1\n1e-9,2\n3e-9,1\n", {}),
              HasSubstr("row 1: found the time 1e-09 s; expected 1.5e-09 s"));
  EXPECT_THAT(refusal("2e-9,1\n1e-9,2\n", {}), HasSubstr("do not increase"));
  EXPECT_THAT(refusal("time_s,value\n0,1\n", {}), HasSubstr("found one time"));
  EXPECT_THAT(refusal("1,2,3\n", 1e-9), HasSubstr("found 3 columns"));
  EXPECT_THAT(refusal("value,time_s\n1,1\n1,0\n", {}), HasSubstr("do not increase"));
  EXPECT_THAT(refusal("0,1\n1e-9,2\n", 2e-9), HasSubstr("expected time_step_s = 2e-09"));
  EXPECT_THAT(refusal("1\n-1\n", 1e-9), HasSubstr("samples sum = 0; must be > 0"));
  EXPECT_THAT(refusal("1\n", -1.0), HasSubstr("time_step_s = -1; must be finite and > 0"));
  EXPECT_THAT(io_error_of([&] { read_impulse_response("r.png", 1e-9); }),
              HasSubstr("expected one of .csv, .txt, .tsv, .dat, .npy"));
  write_npy(directory_ / "r.npy", NpyArray(NpyType::float64, {3, 2}), OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_impulse_response(directory_ / "r.npy", 1e-9); }),
              HasSubstr("found an array of shape (3, 2); expected one axis"));
}

TEST(WaveformsToCsv, HasOneRowPerSampleAndOneColumnPerWaveform) {
  const CodeSet code = CodeSet::create("x", 4, 2, {Waveform::binary({{0.0, 0.375}}, 2.0)},
                                       {square_wave(1, 0.0), square_wave(1, 0.5)});
  EXPECT_EQ(waveforms_to_csv(code, 10e6),
            "time_s,modulation_1,demodulation_1,demodulation_2\n"
            "0,2,1,0\n"
            "2.5e-08,1,1,0\n"
            "5e-08,0,0,1\n"
            "7.5e-08,0,0,1\n");
}

}  // namespace

}  // namespace tofsmith

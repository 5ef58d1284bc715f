// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/impulse_response.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Eigen::MatrixXd two_rows() {
  Eigen::MatrixXd expected(2, 2);
  expected << 0.5, -1.25, 1.5, 3e-3;
  return expected;
}

TEST(InstrumentTable, ReadsEveryDelimiterAndDecimalMark) {
  for (const char* text :
       {"0.5,-1.25\n1.5,3e-3\n", "0.5;-1.25\n1.5;3e-3\n", "0.5\t-1.25\r\n1.5\t3e-3\r\n",
        "0.5   -1.25\n1.5 3e-3", "0,5;-1,25\n1,5;3e-3\n", "0,5\t-1,25\n1,5\t3e-3\n",
        "0,5 -1,25\n1,5 3e-3\n", "\"0.5\",\"-1.25\"\n1.5,3e-3\n", "0.5,-1.25,,\n1.5,3e-3,,\n"})
    EXPECT_EQ(parse_instrument_table(text, "t.csv").values, two_rows()) << text;
}

TEST(InstrumentTable, SkipsTextAndTakesTheLastLineOfItForNames) {
  const InstrumentTable table = parse_instrument_table(
      "\xef\xbb\xbfModel,DSO-X\nRecord Length,2\n# kept apart\nTime (ns),Ch "
      "1\n0.5,-1.25\n1.5,3e-3\n",
      "t.csv");
  EXPECT_THAT(table.names, ElementsAre("Time (ns)", "Ch 1"));
  EXPECT_EQ(table.values, two_rows());
  EXPECT_THAT(table.lines, ElementsAre(5u, 6u));
  EXPECT_THAT(table.notes, ElementsAre(HasSubstr("2 lines of text")));
}

TEST(InstrumentTable, CommasThatCouldBeEitherAreSettledOrRefused) {
  EXPECT_EQ(parse_instrument_table("0,5\n1,7\n2,4\n", "t.csv").values.cols(), 2);  // bins rise
  EXPECT_EQ(parse_instrument_table("a,b\n4,5\n1,7\n", "t.csv").values.cols(), 2);
  EXPECT_EQ(parse_instrument_table("a\n4,5\n1,7\n", "t.csv").values(0, 0), 4.5);
  const auto refusal = [](const char* text) {
    return io_error_of([&] { parse_instrument_table(text, "t.csv"); });
  };
  EXPECT_THAT(refusal("4,5\n1,7\n"), HasSubstr("t.csv:1: found '4,5', which can be 2 columns"));
  EXPECT_EQ(parse_instrument_table("4,5\n1,7\n", "t.csv", DecimalMark::comma).values(1, 0), 1.7);
  EXPECT_EQ(parse_instrument_table("4,5\n1,7\n", "t.csv", DecimalMark::point).values(1, 1), 7);
}

TEST(InstrumentTable, NamesThePlaceOfWhatItCannotRead) {
  const auto refusal = [](const char* text) {
    return io_error_of([&] { parse_instrument_table(text, "t.csv"); });
  };
  EXPECT_EQ(refusal("t,v\n1.5,2\n2.5,nan\n"),
            "t.csv:3: found 'nan' in column 2; expected a finite number");
  EXPECT_EQ(refusal("1.5,2\n2.5,x\n"), "t.csv:2: found 'x' in column 2; expected a finite number");
  EXPECT_EQ(refusal("1.5,2\n2.5\n"), "t.csv:2: found 1 columns; expected 2 as in line 1");
  EXPECT_EQ(refusal("a,b\n"), "t.csv: found no row of numbers; expected at least one");
  EXPECT_EQ(refusal(""), "t.csv: found no row of numbers; expected at least one");
  EXPECT_THAT(refusal("1e999;2\n"), HasSubstr("found '1e999' in column 1"));
}

TEST(InstrumentTable, KnowsUnitsOfTime) {
  EXPECT_EQ(seconds_per_unit("time_ns"), 1e-9);
  EXPECT_EQ(seconds_per_unit("Time (us)"), 1e-6);
  EXPECT_EQ(seconds_per_unit("delay [ps]"), 1e-12);
  EXPECT_EQ(seconds_per_unit("Second"), 1.0);
  EXPECT_EQ(seconds_per_unit("Volts"), 0.0);
}

class RecordFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(directory_ / "r.csv") << text;
    return directory_ / "r.csv";
  }
  std::string rows(double second_step, const std::string& header = "time_ns,v\n") const {
    std::string text = header;
    double t = 0.0;
    for (int i = 0; i < 20; ++i) {
      text += fmt::format("{},{}\n", t, 2 * t);
      t += i == 9 ? second_step : 1.0;
    }
    return text;
  }
  std::string refusal(const std::string& text, const ResponseRecordOptions& options = {}) const {
    return io_error_of([&] { read_response_record(write(text), options); });
  }
  TemporaryDirectory directory_;
};

TEST_F(RecordFile, TakesTimesInTheUnitOfTheirName) {
  const ResponseRecord record = read_response_record(write(rows(1.0)));
  EXPECT_NEAR(record.time_step_s, 1e-9, 1e-18);
  EXPECT_EQ(record.values.size(), 20);
  EXPECT_TRUE(record.notes.empty());
  const ResponseRecord seconds = read_response_record(write(rows(1.0, "")));
  EXPECT_NEAR(seconds.time_step_s, 1.0, 1e-9);
  EXPECT_THAT(seconds.notes, ElementsAre(HasSubstr("taken as seconds")));
}

TEST_F(RecordFile, ResamplesUnequalTimesWithANote) {
  const ResponseRecord record = read_response_record(write(rows(2.5)));
  EXPECT_THAT(record.notes, ElementsAre(HasSubstr("not equally spaced")));
  for (Eigen::Index i = 0; i < record.values.size(); ++i)  // values are linear in time
    EXPECT_NEAR(record.values[i], 2e9 * record.time_step_s * static_cast<double>(i), 1e-6);
}

TEST_F(RecordFile, RefusesTimesThatFallOrLeap) {
  EXPECT_THAT(refusal(rows(-3.0)), HasSubstr("r.csv:12: found the time 6e-09 s after 9e-09 s"));
  EXPECT_THAT(refusal(rows(0.0)), HasSubstr("expected times that rise"));
  EXPECT_THAT(refusal(rows(50.0)), HasSubstr("found a gap of 5e-08 s"));
  EXPECT_THAT(refusal("1.5\n2.5\n"), HasSubstr("found 2 values; expected at least 16"));
}

TEST_F(RecordFile, AsksForTheColumnAndTheStepItNeeds) {
  std::string three = "t_s,ch1,ch2\n", one;
  for (int i = 0; i < 20; ++i) {
    three += fmt::format("{},{}.5,{}\n", 1e-3 * i, i, i);
    one += std::to_string(i) + ".25\n";
  }
  EXPECT_THAT(refusal(three), HasSubstr("expected --column"));
  EXPECT_EQ(read_response_record(write(three), {.column = "ch1"}).values[3], 3.5);
  EXPECT_EQ(read_response_record(write(three), {.column = "3"}).values[3], 3.0);
  EXPECT_THAT(refusal(three, {.column = "ch7"}), HasSubstr("found no column ch7"));
  EXPECT_THAT(refusal(one), HasSubstr("expected --time-step"));
  EXPECT_EQ(read_response_record(write(one), {.time_step_s = 2e-12}).time_step_s, 2e-12);
}

TEST_F(RecordFile, TakesWholeNumbersForCounts) {
  std::vector<std::int32_t> counts(32, 4);
  counts[7] = 90;
  write_npy(directory_ / "h.npy", NpyArray::of<std::int32_t>({32}, counts),
            OutputPolicy::overwrite);
  EXPECT_TRUE(read_response_record(directory_ / "h.npy", {.time_step_s = 8e-12}).counts);
  std::vector<double> values(32, 0.5);
  values[3] = NAN;
  write_npy(directory_ / "h.npy", NpyArray::of<double>({32}, values), OutputPolicy::overwrite);
  EXPECT_THAT(
      io_error_of([&] { read_response_record(directory_ / "h.npy", {.time_step_s = 8e-12}); }),
      HasSubstr("h.npy[3]: found nan"));
}

}  // namespace
}  // namespace tofsmith

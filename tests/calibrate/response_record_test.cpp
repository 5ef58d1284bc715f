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

TEST_F(RecordFile, TimesAreInTheUnitOfTheirName) {
  const ResponseRecord record = read_response_record(write(rows(1.0)));
  EXPECT_NEAR(record.time_step_s, 1e-9, 1e-18);
  EXPECT_EQ(record.values.size(), 20);
  EXPECT_TRUE(record.notes.empty());
  std::string halves;
  for (int i = 0; i < 20; ++i) halves += fmt::format("{},{}\n", 0.5 * i, i);
  const ResponseRecord seconds = read_response_record(write(halves));
  EXPECT_NEAR(seconds.time_step_s, 0.5, 1e-9);
  EXPECT_THAT(seconds.notes, ElementsAre(HasSubstr("interpreted as seconds")));
}

/// Returns multiples of 3 at steps of 0.1 ns, formatted by `row(number, time, value)`.
std::string record_text(const std::string& header, auto&& row) {
  std::string text = header;
  for (int i = 0; i < 20; ++i) text += row(i, fmt::format("{:.4e}", 1e-10 * i), 3.0 * i);
  return text;
}

TEST_F(RecordFile, IsReadFromEveryOscilloscope) {
  const auto timed = [](int, const std::string& t, double v) {
    return fmt::format("{},{}\n", t, v);
  };
  const auto counted = [](int i, const std::string&, double v) {
    return fmt::format("{},{},\n", i, v);
  };
  const auto values = [](int, const std::string&, double v) { return fmt::format("{},\n", v); };
  const auto after_empty = [](int, const std::string&, double v) {
    return fmt::format(",{}\n", v);
  };
  const auto next_to_header = [](int i, const std::string& t, double v) {
    return fmt::format("{},{},{},\n",
                       i == 0   ? "Record Length,20,"
                       : i == 1 ? "Sample Interval,1e-10,"
                       : i == 5 ? "Source,CH1,"
                                : ",,",
                       t, v);
  };
  const auto numbered = [](int i, const std::string& t, double v) {
    return fmt::format("{},{},{},7\n", i, t, v);
  };
  struct {
    std::string text, column = {};
  } const files[] = {
      {record_text("", next_to_header)},
      {record_text("", next_to_header), "5"},
      {record_text("X,CH1,Start,Increment,\nSequence,Volt,-1e-9,1.0e-10\n", counted)},
      {record_text("X,CH1,Start,Increment,\nSequence,Volt,-1e-9,1.0e-10\n", counted), "CH1"},
      {record_text("Time interval :0.0001uS\nnr,CH1 (V)\n", counted), "CH1"},
      {record_text("CH1V,t0 =-1e-09s, tInc = 1e-10,\n", values)},
      {record_text("Sampling Period,1.0E-10\nWaveform Data,\n", values)},
      {record_text("\"TraceName\",\"CH1\"\n\"HResolution\",1e-10\n\"HUnit\",\"s\"\n", after_empty)},
      {record_text("Model,DPO\nSample Interval,1e-10,\nTIME,CH1\n", timed)},
      {record_text("x-axis,1\nsecond,Volt\n", timed), "1"},
      {record_text("in s,C1 in V\n", timed), "C1"},
      {record_text("nr,time,ch1,ch1s\n", numbered), "ch1"}};
  for (const auto& file : files) {
    for (const std::optional<double> unit_s : {std::optional<double>(), std::optional(1e-9)}) {
      const ResponseRecord record =
          read_response_record(write(file.text), {.time_unit_s = unit_s, .column = file.column});
      EXPECT_NEAR(record.time_step_s, 1e-10, 1e-16) << file.text;
      ASSERT_EQ(record.values.size(), 20) << file.text;
      EXPECT_EQ(record.values[7], 21.0) << file.text;
    }
  }
}

TEST_F(RecordFile, ASampleCounterIsNotATime) {
  const std::string counted = rows(1.0, "");
  EXPECT_THAT(refusal(counted), HasSubstr("found a sample counter in column 1"));
  EXPECT_EQ(read_response_record(write(counted), {.time_step_s = 2e-10}).time_step_s, 2e-10);
  const ResponseRecord record = read_response_record(write(counted), {.time_unit_s = 1e-9});
  EXPECT_NEAR(record.time_step_s, 1e-9, 1e-15);
  EXPECT_THAT(record.notes, ElementsAre(HasSubstr("looks like a sample counter")));
}

TEST_F(RecordFile, ResamplesUnequalTimesWithANote) {
  const ResponseRecord record = read_response_record(write(rows(2.5)));
  EXPECT_THAT(record.notes, ElementsAre(HasSubstr("not equally spaced")));
  for (Eigen::Index i = 0; i < record.values.size(); ++i)  // values are linear in time
    EXPECT_NEAR(record.values[i], 2e9 * record.time_step_s * static_cast<double>(i), 1e-6);
}

TEST_F(RecordFile, RejectsDecreasingOrIrregularTimes) {
  EXPECT_THAT(refusal(rows(-3.0)), HasSubstr("r.csv:12: found the time 6e-09 s after 9e-09 s"));
  EXPECT_THAT(refusal(rows(0.0)), HasSubstr("expected increasing times"));
  EXPECT_THAT(refusal(rows(50.0)), HasSubstr("found a gap of 5e-08 s"));
  EXPECT_THAT(refusal("1.5\n2.5\n"), HasSubstr("found 2 values; expected at least 16"));
}

TEST_F(RecordFile, ReportsTheMissingColumnOrStep) {
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

TEST_F(RecordFile, InterpretsIntegersAsCounts) {
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

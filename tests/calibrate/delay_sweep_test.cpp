// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;

class SweepFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name) << text;
    return directory_ / name;
  }
  std::string rows(int count, const std::string& header) const {
    std::string text = header;
    for (int i = 0; i < count; ++i)
      text += std::to_string(5 * i) + ".0," + std::to_string(i % 3) + ".5,1.25\n";
    return text;
  }
  TemporaryDirectory directory_;
};

TEST_F(SweepFile, TextHasDelaysInTheUnitOfItsHeader) {
  const DelaySweepOptions options{.fundamental_frequency_hz = 10e6};  // 100 ns: 20 steps of 5 ns
  const DelaySweep sweep = read_delay_sweep(write("s.csv", rows(21, "delay_ns,a,b\n")), options);
  EXPECT_EQ(sweep.frames.frames, 21);
  EXPECT_EQ(sweep.frames.measurements, 2);
  EXPECT_NEAR(sweep.delay_periods[1], 0.05, 1e-12);
  EXPECT_NEAR(sweep.delay_periods[20], 1.0, 1e-12);
  DelaySweepOptions in_metres = options;
  in_metres.unit = DelayUnit::metre;
  in_metres.unit_scale = 299792458.0 / 2e7 / 100;  // a hundredth of the range
  EXPECT_NEAR(read_delay_sweep(write("s.csv", rows(21, "")), in_metres).delay_periods[1], 0.05,
              1e-12);
}

TEST_F(SweepFile, IsIndependentOfTheDialect) {
  const DelaySweepOptions options{.fundamental_frequency_hz = 10e6};
  const DelaySweep expected = read_delay_sweep(write("s.csv", rows(21, "delay_ns,a,b\n")), options);
  std::string commas = "\xef\xbb\xbfn;delay;a;b\n;ns;DN;DN\n", beside;
  for (int i = 0; i < 21; ++i) {
    commas += fmt::format("{};{},0;{},5;1,25;\r\n", i, 5 * i, i % 3);
    beside += fmt::format("{},,{}.0e-9,{}.5,1.25\n", i == 0 ? "Model,A" : ",", 5 * i, i % 3);
  }
  for (const auto& [name, text] : {std::pair("S.CSV", commas), std::pair("s.tsv", beside)}) {
    const DelaySweep sweep = read_delay_sweep(write(name, text), options);
    EXPECT_EQ(sweep.frames.values, expected.frames.values) << text;
    for (std::size_t i = 0; i < 21; ++i)
      EXPECT_NEAR(sweep.delay_periods[i], expected.delay_periods[i], 1e-12) << text;
  }
}

TEST_F(SweepFile, ReportsTheMissingPartOfThePeriod) {
  const DelaySweepOptions options{.fundamental_frequency_hz = 10e6};
  EXPECT_THAT(
      io_error_of([&] { read_delay_sweep(write("s.csv", rows(12, "delay_ns,a,b\n")), options); }),
      HasSubstr("s.csv: delays = 0.55 periods long in steps of 0.05; must cover a whole period "
                "without a gap: delays from 0.6 to 0.95"));
}

TEST_F(SweepFile, AStackHasAListOfShifts) {
  std::vector<float> values(12 * 2 * 2 * 3, 1.0f);
  write_npy(directory_ / "f.npy", NpyArray::of<float>({12, 2, 2, 3}, values),
            OutputPolicy::overwrite);
  std::string shifts;
  for (int i = 0; i < 12; ++i) shifts += std::to_string(20 * i) + "\n";
  const DelaySweepOptions options{.shifts = write("t.txt", shifts), .unit = DelayUnit::bin};
  const DelaySweep sweep = read_delay_sweep(directory_ / "f.npy", options);
  EXPECT_EQ(sweep.frames.height, 2);
  EXPECT_NEAR(sweep.delay_periods[3], 0.25, 1e-12);
  write("t.txt", "1\n2\n");
  EXPECT_THAT(io_error_of([&] { read_delay_sweep(directory_ / "f.npy", options); }),
              HasSubstr("found 2 shifts; expected 12"));
}

TEST_F(SweepFile, AnArrayIsOnePeriodInEqualSteps) {
  std::vector<double> values;
  for (int n = 0; n <= 16; ++n)
    for (int k = 0; k < 3; ++k) values.push_back((n % 16) * (k + 1.0));
  write_npy(directory_ / "t.npy", NpyArray::of<double>({17, 3}, values), OutputPolicy::overwrite);
  const DelaySweep sweep = read_delay_sweep(directory_ / "t.npy", {});
  EXPECT_EQ(sweep.frames.frames, 16);  // the repeated end point is removed
  EXPECT_THAT(sweep.notes, Contains(HasSubstr("repeats the first and was dropped")));
  EXPECT_THAT(sweep.notes, Contains(HasSubstr("equal steps of one period")));
}

TEST(DelayUnit, HasKnownNames) {
  EXPECT_EQ(parse_delay_unit("ns"), DelayUnit::second);
  EXPECT_EQ(parse_delay_unit("bin"), DelayUnit::bin);
  EXPECT_THROW(parse_delay_unit("furlong"), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/impulse_response.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/shared/random.hpp"
#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using Kind = ImpulseResponse::Kind;
using testing::HasSubstr;

constexpr double step_s = 0.1e-9;
constexpr int count = 1200;

ImpulseResponse response_of(Kind kind) {
  return {.kind = kind, .f_max_hz = 150e6, .cutoff_hz = 90e6};
}

/// A noisy oscilloscope record of a response that starts at `onset_s`, computed from its transfer
/// function, with height 1.
ResponseRecord record_of(const ImpulseResponse& response, Excitation excitation, double noise,
                         std::uint64_t seed) {
  constexpr int harmonics = 6000;
  constexpr double period_s = 4 * count * step_s, onset_s = 40e-9;
  ResponseRecord record;
  record.time_step_s = step_s;
  record.values.resize(count);
  const double pi = std::numbers::pi;
  for (int i = 0; i < count; ++i) {
    // A pulse, or a square wave that is on for half the period.
    const double t = i * step_s - onset_s;
    double value = excitation == Excitation::step ? 0.5 : 1.0;
    for (int n = 1; n <= harmonics; ++n) {
      const double f = n / period_s;
      std::complex<double> h = response.transfer(f);
      if (std::abs(h) < 1e-7) continue;
      if (excitation == Excitation::step)
        h *= (1.0 - std::polar(1.0, -pi * n)) / std::complex<double>(0.0, 2 * pi * n);
      value += 2 * (h * std::polar(1.0, 2 * pi * f * t)).real();
    }
    record.values[i] = value;
  }
  const double height =
      excitation == Excitation::step ? 1.0 : record.values.maxCoeff() - record.values.minCoeff();
  RandomStream random(seed, 1);
  for (double& value : record.values)
    value = 0.3 + 2.0 * (value / height + noise * random.normal());
  return record;
}

const ParametricResponse& fit_of(const CalibratedResponse& result, Kind kind) {
  for (const ParametricResponse& fit : result.fits)
    if (fit.response.kind == kind) return fit;
  ADD_FAILURE() << "no fit of " << name_of(kind);
  return result.fits.front();
}

class Recovers : public testing::TestWithParam<std::tuple<Kind, Excitation>> {};

TEST_P(Recovers, TheBandwidthWithinTwoPercentAt40Decibels) {
  const auto [kind, excitation] = GetParam();
  const ImpulseResponse truth = response_of(kind);
  const double true_hz = bandwidth_hz(truth);
  ResponseRecord clean = record_of(truth, excitation, 0.0, 0);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    ResponseRecord record = clean;
    RandomStream random(seed, 2);
    for (double& value : record.values) value += 2.0 * 0.01 * random.normal();
    const CalibratedResponse result = calibrate_impulse_response(record);
    EXPECT_EQ(result.excitation, excitation);
    EXPECT_NEAR(result.snr_db, 40.0, 1.5);
    EXPECT_TRUE(result.fit_is_good());
    EXPECT_EQ(result.fits.front().response.kind, kind);
    const Estimate fitted = fit_of(result, kind).bandwidth_hz;
    EXPECT_NEAR(fitted.value, true_hz, 0.02 * true_hz);
    EXPECT_NEAR(fitted.value, true_hz, 4 * fitted.standard_error);
    EXPECT_LT(fitted.standard_error, 0.01 * true_hz);
    // The bandwidth does not depend on an assumed kind of response.
    EXPECT_NEAR(result.bandwidth_hz.value, true_hz, 0.05 * true_hz);
    EXPECT_NEAR(bandwidth_hz(result.response), true_hz, 0.06 * true_hz);
    EXPECT_EQ(result.peaks.size(), 1u);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Recovers,
                         testing::Combine(testing::Values(Kind::hann, Kind::gaussian,
                                                          Kind::lowpass),
                                          testing::Values(Excitation::pulse, Excitation::step)));

TEST(CalibratedResponse, IsCentredAndOnTheCamerasGrid) {
  const CalibratedResponse result = calibrate_impulse_response(
      record_of(response_of(Kind::gaussian), Excitation::pulse, 0.003, 3));
  EXPECT_NEAR(result.delay_s, 40e-9, 0.05e-9);
  const double steps = 1.0 / (15e6 * 240) / result.response.time_step_s;
  EXPECT_NEAR(steps, std::round(steps), 1e-9);
  const double centre = result.response_centre_s / result.response.time_step_s;
  EXPECT_NEAR(centre, std::round(centre), 1e-6);
  double moment_s = 0.0;
  for (std::size_t i = 0; i < result.response.samples.size(); ++i)
    moment_s += result.response.samples[i] * static_cast<double>(i) * result.response.time_step_s;
  EXPECT_NEAR(moment_s, result.response_centre_s, 0.02e-9);
  for (const double f_hz : {15e6, 45e6, 90e6}) {
    const std::complex<double> centred =
        result.response.transfer(f_hz) *
        std::polar(1.0, 2 * std::numbers::pi * f_hz * result.response_centre_s);
    EXPECT_NEAR(std::abs(centred - response_of(Kind::gaussian).transfer(f_hz)), 0.0, 0.02);
  }
}

TEST(CalibratedResponse, StandardErrorsAreCorrect) {
  const ResponseRecord clean = record_of(response_of(Kind::gaussian), Excitation::pulse, 0.0, 0);
  const double true_hz = bandwidth_hz(response_of(Kind::gaussian));
  double fitted = 0.0, measured = 0.0;
  constexpr int seeds = 24;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    ResponseRecord record = clean;
    RandomStream random(seed, 3);
    for (double& value : record.values) value += 0.02 * random.normal();
    const CalibratedResponse result = calibrate_impulse_response(record);
    const auto square = [&](const Estimate& e) {
      return std::pow((e.value - true_hz) / e.standard_error, 2) / seeds;
    };
    fitted += square(fit_of(result, Kind::gaussian).bandwidth_hz);
    measured += square(result.bandwidth_hz);
  }
  EXPECT_GT(fitted, 0.35);  // reduced chi^2, 24 degrees of freedom
  EXPECT_LT(fitted, 2.2);
  EXPECT_GT(measured, 0.3);
  EXPECT_LT(measured, 3.0);
}

TEST(CalibratedResponse, KeepsASecondPeakWithANote) {
  ResponseRecord record = record_of(response_of(Kind::gaussian), Excitation::pulse, 0.0, 0);
  const Eigen::VectorXd once = record.values;
  for (Eigen::Index i = 150; i < count; ++i) record.values[i] += 0.6 * (once[i - 150] - 0.3);
  RandomStream random(5, 4);
  for (double& value : record.values) value += 0.01 * random.normal();
  const CalibratedResponse result = calibrate_impulse_response(record);
  ASSERT_EQ(result.peaks.size(), 2u);
  EXPECT_NEAR(result.peaks[1].height, 0.6, 0.03);
  EXPECT_NEAR(result.peaks[1].time_s, 15e-9, 0.3e-9);
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("second peak of 0.6")));
}

TEST(CalibratedResponse, ReportsAPulseWithAFlatTop) {
  const auto has_note = [](const ResponseRecord& record) {
    for (const std::string& note : calibrate_impulse_response(record).notes)
      if (note.find("the top of the pulse is flat") != std::string::npos) return true;
    return false;
  };
  const ResponseRecord whole = record_of(response_of(Kind::gaussian), Excitation::pulse, 0.005, 4);
  EXPECT_FALSE(has_note(whole));
  ResponseRecord rounded = whole;  // to 100 levels
  rounded.values = (50 * whole.values.array()).round() / 50;
  EXPECT_FALSE(has_note(rounded));
  for (ResponseRecord clipped : {whole, rounded}) {
    clipped.values = clipped.values.cwiseMin(1.5).eval();
    EXPECT_TRUE(has_note(clipped));
    clipped.values *= -1.0;
    EXPECT_TRUE(has_note(clipped));
  }
}

TEST(CalibratedResponse, InvertsFallingRecordsAndRotatesWrappedOnes) {
  const ResponseRecord clean = record_of(response_of(Kind::hann), Excitation::pulse, 0.002, 7);
  const double expected_hz = calibrate_impulse_response(clean).fits.front().bandwidth_hz.value;
  ResponseRecord falling = clean;
  falling.values = -clean.values;
  const CalibratedResponse turned = calibrate_impulse_response(falling);
  EXPECT_TRUE(turned.falling);
  EXPECT_NEAR(turned.fits.front().bandwidth_hz.value, expected_hz, 1e-6 * expected_hz);
  ResponseRecord rolled = clean;
  for (int i = 0; i < count; ++i) rolled.values[i] = clean.values[(i + 400) % count];
  const CalibratedResponse unrolled = calibrate_impulse_response(rolled);
  EXPECT_NEAR(unrolled.fits.front().bandwidth_hz.value, expected_hz, 1e-3 * expected_hz);
  EXPECT_THAT(unrolled.notes, testing::Contains(HasSubstr("a whole period and rotated")));
}

TEST(CalibratedResponse, RejectsARecordWithoutAResponse) {
  ResponseRecord record;
  record.time_step_s = 1e-9;
  record.values = Eigen::VectorXd::Zero(100);
  EXPECT_THROW(calibrate_impulse_response(record), std::invalid_argument);
  record.values.resize(3);
  EXPECT_THROW(calibrate_impulse_response(record), std::invalid_argument);
}

using testing::ElementsAre;

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

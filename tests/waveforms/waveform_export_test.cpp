// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/waveform_export.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "camera/shared/actual_code.hpp"
#include "refusal.hpp"
#include "tofsmith/io/number_table.hpp"
#include "waveform_readers.hpp"
#include "waveforms/generator_formats.hpp"
#include "waveforms/pattern_memory.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

std::string_view text_of(const ExportedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

std::string problem_of(const CodeSet& code, const Camera& camera, const ExportOptions& options) {
  return refusal_of([&] {
    export_files(export_waveforms(code, exporting_camera(code, camera, options), options));
  });
}

std::vector<double> values_read_back(const ExportedFile& file, const QuantizedWaveform& w,
                                     const WaveformExport& exported) {
  const std::string& format = exported.format.name;
  std::vector<double> values;
  const auto add = [&](double share) { values.push_back(share * w.full_scale); };
  if (format == "siglent-csv") {
    const EasyWaveTable table = parse_easywave_csv(text_of(file));
    for (const double v : table.volts) add((v - w.low_v) / (w.high_v - w.low_v));
  } else if (format == "siglent-wvdt14" || format == "siglent-wvdt16") {
    const auto points = format == "siglent-wvdt16" ? WvdtPoints::bits16_little_endian
                                                   : WvdtPoints::bits14_little_endian;
    for (const int p : parse_wvdt(file.bytes, points).points)
      add(static_cast<double>(p + w.levels / 2) / (w.levels - 1));
  } else if (format == "keysight-arb") {
    for (const int p : parse_keysight_arb(text_of(file)).points) add((p + 32767) / 65534.0);
  } else if (format == "tek-tfw") {
    for (const int p : parse_tektronix_tfw(file.bytes)) add(p / 16382.0);
  } else {
    for (const float v : parse_tektronix_wfm(file.bytes).values) add(0.5 * (v + 1.0));
  }
  return values;
}

// Evaluation and files agree to half a step of the format, for binary and analog waveforms, also
// with fewer bits than the format has.
TEST(WaveformExport, FilesMatchTheActualWaveformsWithinHalfAStep) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.binary = camera.sensor.binary = false;
  for (const char* family : {"sinusoid-k4", "hamiltonian-k5"}) {
    const CodeSet code = build_family(family, camera);
    for (const WaveformFormat& format : waveform_formats()) {
      if (format.content != FormatContent::one_waveform) continue;
      for (const std::optional<int> bits : {std::optional<int>(), std::optional<int>(6)}) {
        SCOPED_TRACE(fmt::format("{} {} {}", family, format.name, bits.value_or(0)));
        const ExportOptions options{.format = format.name, .bits = bits};
        const Camera actual = exporting_camera(code, camera, options);
        const WaveformExport exported = export_waveforms(code, actual, options);
        const ActualCode truth = actual_code(code, actual);
        const auto files = export_files(exported);
        ASSERT_EQ(files.size(), exported.waveforms.size());
        for (std::size_t i = 0; i < files.size(); i += 3) {
          const QuantizedWaveform& w = exported.waveforms[i];
          const auto index = static_cast<std::size_t>(w.index);
          const Waveform& nominal =
              w.arm == Arm::light ? truth.modulation[index] : truth.demodulation[index];
          const Eigen::VectorXd expected = nominal.cell_averages(w.points_per_period());
          const std::vector<double> values = values_read_back(files[i], w, exported);
          ASSERT_EQ(values.size(), w.codes.size());
          double largest = 0.0;
          for (std::size_t j = 0; j < values.size(); ++j)
            largest = std::max(
                largest, std::abs(values[j] -
                                  expected[static_cast<Eigen::Index>(j) % w.points_per_period()]));
          EXPECT_LE(largest, 0.5 * w.step() * (1 + 1e-6));
        }
      }
    }
  }
}

TEST(WaveformExport, WordsAndColumnsContainAllWaveforms) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k5", camera);
  for (const WaveformFormat& format : waveform_formats()) {
    if (format.content == FormatContent::one_waveform) continue;
    const ExportOptions options{.format = format.name};
    const WaveformExport exported =
        export_waveforms(code, exporting_camera(code, camera, options), options);
    const auto files = export_files(exported);
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].waveforms.size(), 10u);
    if (format.name == "csv") {
      const NumberTable table = parse_number_table(text_of(files[0]), files[0].name);
      ASSERT_EQ(table.values.cols(), 12);
      EXPECT_EQ(table.names[1], "trigger");
      EXPECT_EQ(table.values.rows(), 240);
      EXPECT_NEAR((table.values.middleCols(2, 5) - code.modulation_samples()).cwiseAbs().maxCoeff(),
                  0.0, 15 * 0.5 / 16383);
    } else if (format.name == "verilog-mem") {
      const auto words = parse_pattern(text_of(files[0]), {"", ""}).words;
      ASSERT_EQ(words.size(), 5u * 240);
      const Eigen::MatrixXd light = code.modulation_samples(), sensor = code.demodulation_samples();
      for (int e = 0; e < 5; ++e)
        for (int j = 0; j < 240; ++j) {
          const std::uint64_t word = words[static_cast<std::size_t>(240 * e + j)];
          EXPECT_EQ(word & 1, light(j, e) > 0 ? 1u : 0u);
          EXPECT_EQ(word >> 1 & 1, sensor(j, e) > 0 ? 1u : 0u);
          EXPECT_EQ(word >> 2, j < 120 ? 1u : 0u);
        }
    }
  }
}

TEST(WaveformExport, TapsOfTheSameGeneratorAreExportedOnce) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const ExportOptions options{.format = "keysight-arb"};
  const Camera actual = exporting_camera(code, camera, options);
  EXPECT_EQ(actual.light.generator->points_per_period(5e6), 100);  // of this generator
  const WaveformExport exported = export_waveforms(code, actual, options);
  EXPECT_TRUE(exported.shared_taps);
  ASSERT_EQ(exported.waveforms.size(), 8u);
  EXPECT_EQ(exported.waveforms[5].name, "demodulation_3");
  const auto json = nlohmann::json::parse(export_manifest(exported, export_files(exported)));
  EXPECT_EQ(json["second_tap"], "1 - the first tap");
}

TEST(WaveformExport, RepeatsPeriodsAsRequiredByTheFormat) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  ExportOptions options{.format = "tek-wfm", .samples = 75};
  const WaveformExport exported =
      export_waveforms(code, exporting_camera(code, camera, options), options);
  EXPECT_EQ(exported.waveforms[0].periods, 4);  // 300 points: a multiple of 4, at least 256
  EXPECT_NEAR(exported.waveforms[0].repetition_hz(), 15e6 / 4, 1e-6);
  options.periods = 5;
  EXPECT_THAT(problem_of(code, camera, options),
              HasSubstr("points = 375; tek-wfm requires 256 to 1048576 points in multiples of 4"));
}

TEST(WaveformExport, OutputVoltagesFollowPower) {
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet code =
      CodeSet::create("two", 240, 1, {rectangular_pulse(0.1), rectangular_pulse(0.2)},
                      {square_wave(1, 0.0), square_wave(1, 0.25)});
  const ExportOptions options{.format = "csv", .low_v = -1.0, .high_v = 3.0};
  const WaveformExport exported =
      export_waveforms(code, exporting_camera(code, camera, options), options);
  EXPECT_NEAR(exported.waveforms[0].high_v, 3.0, 1e-12);  // peak 10
  EXPECT_NEAR(exported.waveforms[1].high_v, 1.0, 1e-12);  // peak 5
  EXPECT_NEAR(exported.waveforms[2].high_v, 3.0, 1e-12);  // gain 1
  EXPECT_EQ(exported.waveforms[1].low_v, -1.0);
}

TEST(Manifest, DescribesEachFile) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const ExportOptions options{.format = "tek-wfm", .samples = 120};
  const WaveformExport exported =
      export_waveforms(code, exporting_camera(code, camera, options), options);
  const auto files = export_files(exported);
  const auto json = nlohmann::json::parse(export_manifest(exported, files));
  EXPECT_EQ(json["format"], "tek-wfm");
  EXPECT_EQ(json["variant"], "crlf");
  EXPECT_EQ(json["light"]["table_points"], 120);
  ASSERT_EQ(json["files"].size(), 6u);
  const auto& last = json["files"][5];
  EXPECT_EQ(last["file"], "demodulation_3.wfm");
  EXPECT_EQ(last["waveforms"][0]["exposure"], 3);
  EXPECT_EQ(last["waveforms"][0]["tap"], 1);
  EXPECT_EQ(last["waveforms"][0]["points"], 360);
  EXPECT_EQ(last["waveforms"][0]["periods"], 3);
}

TEST(WaveformExport, RejectsUnsupportedHardwareSettings) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const auto problem = [&](const ExportOptions& options) {
    return problem_of(code, camera, options);
  };
  EXPECT_THAT(problem({.format = "siglent-cvs"}),
              HasSubstr("must be one of siglent-csv, siglent-wvdt14"));
  EXPECT_THAT(problem({.format = "siglent-cvs"}), HasSubstr("did you mean siglent-csv?"));
  EXPECT_THAT(problem({.format = "siglent-csv", .variant = "x"}),
              HasSubstr("must be one of easywave, lenth, commas"));
  EXPECT_THAT(
      problem({.format = "tek-tfw", .samples = 200000}),
      HasSubstr("samples = 200000; must be in [2, 131072], the limits of the memory of tek-tfw"));
  EXPECT_THAT(problem({.format = "siglent-csv", .samples = 1000}),
              HasSubstr("siglent-csv requires 16384 to 16384 points"));
  EXPECT_THAT(problem({.format = "tek-tfw", .bits = 15}),
              HasSubstr("bits = 15; must be in [1, 14] (tek-tfw)"));
  EXPECT_THAT(problem({.format = "keysight-arb", .samples = 100, .sample_rate_hz = 250e6}),
              HasSubstr("samples = 100; must be at most 16"));
  EXPECT_THAT(problem({.format = "csv", .edge_grid_s = 7e-9}), HasSubstr("edge_grid_s"));
  EXPECT_THAT(problem({.format = "csv", .periods = 0}), HasSubstr("periods = 0"));
  EXPECT_THAT(problem({.format = "csv", .low_v = 1.0, .high_v = 1.0}), HasSubstr("high_v = 1"));
  EXPECT_THAT(problem({.format = "csv", .samples = 2}), HasSubstr("has no pulse"));
  Camera analog = camera;
  analog.light.binary = analog.sensor.binary = false;
  EXPECT_THAT(
      problem_of(build_family("sinusoid-k4", analog), analog, {.format = "vhdl", .bits = 1}),
      HasSubstr("bits = 1; must be >= 2: not all waveforms of sinusoid-k4 are binary"));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/camera_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "damaged_files.hpp"
#include "rows_setup.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = ImpulseResponse::Kind;

// All tables, as shown in the documentation.
constexpr std::string_view documented = R"(fundamental_frequency_hz = 15e6
exposure_s = 0.3                 # total
samples = 240                    # N

[light]
peak_factor = 15                 # P_max / P_ave
binary = true
impulse_response = { kind = "hann", f_max_hz = 150e6 }

[sensor]
taps = 1
binary = true
impulse_response = { kind = "hann", f_max_hz = 150e6 }
read_noise_e = 20

[lens]
fx_px = 525.0
fy_px = 525.0
cx_px = 319.5
cy_px = 239.5

[operating]
signal_e_per_s  = [1e3, 3.1623e3, 1e4, 3.1623e4, 1e5]
ambient_e_per_s = [1e2, 1e3, 1e4, 3.1623e4, 1e5]
error = "linear"
albedo = 1.0

[operating.multipath]
ratio = [0.1, 0.4]
delay_m = [0.5, 3]
weight = 0.2
)";

constexpr std::string_view shortest = "fundamental_frequency_hz = 20e6\n";

Camera every_field_set() {
  Camera camera;
  camera.name = "a \"quoted\" name\twith \x7f";
  camera.fundamental_frequency_hz = 1e8 / 3;
  camera.exposure_s.each_s = {0.1, 1.0 / 7};
  camera.samples = 1000;
  camera.light.peak_factor = 7;
  camera.light.binary = false;
  camera.light.impulse_response.kind = Kind::lowpass;
  camera.light.impulse_response.cutoff_hz = 1e8;
  camera.light.generator = Generator{.sample_rate_hz = 5.5e8, .amplitude_bits = 10};
  camera.sensor.generator = Generator{};
  camera.sensor.taps = 2;
  camera.sensor.binary = false;
  camera.sensor.impulse_response.kind = Kind::file;
  camera.sensor.impulse_response.samples = {0.25, 1.0, -0.125};
  camera.sensor.impulse_response.time_step_s = 1e-10;
  camera.sensor.read_noise_e = 0.0;
  camera.sensor.noise = NoiseModel::gaussian;
  camera.sensor.dark_current_e_per_s = 12.5;
  camera.sensor.modulation_contrasts = {0.9, 1.0 / 3};
  camera.sensor.full_well_e = 5e4;
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 12.3;
  camera.sensor.black_level_dn = 64;
  camera.sensor.shortest_pulse_s = 1e-9;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.readout_gap_s = 1e-4;
  camera.sensor.frame_period_s = 0.5;
  camera.lens = Lens{500, 501, -1.5, 0};
  camera.blur = LensBlur{.kind = LensBlur::Kind::disc,
                         .focal_length_m = 8e-3,
                         .f_number = 1.4,
                         .focus_distance_m = 1.5,
                         .pixel_pitch_m = 1e-5,
                         .pixel_samples = 3};
  camera.optics = Optics{.source_power_w = 0.5,
                         .wavelength_m = 850e-9,
                         .field_of_view_deg = {70, 55.5},
                         .f_number = 1.4,
                         .pixel_pitch_m = 1e-5,
                         .quantum_efficiency = 0.3,
                         .transmission = 0.8,
                         .fill_factor = 0.9,
                         .filter_width_m = 30e-9,
                         .sunlight_w_per_m2_nm = 0.4};
  camera.operating = {.signal_e_per_s = {1e3},
                      .ambient_e_per_s = {0.0, 1e2},
                      .statistic = ErrorStatistic::rmse,
                      .uniform_albedo = true};
  camera.operating.neighbours = 50;
  camera.operating.working_distance_m = {0.5, 4.0};
  camera.operating.depths = {0.0, 2.5, 1.0};
  camera.operating.multipath = OperatingMultipath{{0.0, 1.0}, {0.25, 1.0 / 3}, 0.125};
  camera.operating.interference =
      OperatingInterference{3, 1.0 / 3, "sinusoid-k4", -1e3, Spreading::signs, 7};
  return camera;
}

std::string refusal(const std::string& text, std::vector<std::string> settings = {}) {
  return io_error_of([&] { parse_camera_toml(text, "c.toml", settings); });
}
std::string with_line(const std::string& line) { return std::string(shortest) + line + "\n"; }

TEST(CameraToml, ReadsEveryTableOfTheDocumentation) {
  const Camera camera = parse_camera_toml(documented, "dir/my-camera.toml");
  EXPECT_EQ(camera.name, "my-camera");
  EXPECT_EQ(camera.fundamental_frequency_hz, 15e6);
  EXPECT_EQ(camera.light.peak_factor, 15.0);
  EXPECT_EQ(camera.light.impulse_response.kind, Kind::hann);
  EXPECT_EQ(camera.sensor.impulse_response.f_max_hz, 150e6);
  EXPECT_EQ(camera.sensor.read_noise_e, 20.0);
  ASSERT_TRUE(camera.lens.has_value());
  EXPECT_EQ(camera.lens->cx_px, 319.5);
  EXPECT_THAT(camera.operating.signal_e_per_s, ElementsAre(1e3, 3.1623e3, 1e4, 3.1623e4, 1e5));
  EXPECT_EQ(camera.operating.error, DepthErrorKind::linear);
  EXPECT_EQ(camera.operating.multipath, (OperatingMultipath{{0.1, 0.4}, {0.5, 3.0}, 0.2}));
}

TEST(CameraToml, OnlyTheFrequencyHasNoDefault) {
  Camera expected;
  expected.name = "c";
  expected.fundamental_frequency_hz = 20e6;
  expected.operating = default_operating_range();
  EXPECT_EQ(parse_camera_toml(shortest, "c.toml"), expected);
  EXPECT_EQ(refusal("samples = 240\n"),
            "c.toml: found no fundamental_frequency_hz; expected a line such as "
            "`fundamental_frequency_hz = 15e6`");
}

TEST(CameraToml, ReadingUndoesWriting) {
  Camera rows = rows_camera();
  rows.sensor.decoder = RowDecoder::plain;
  std::vector<Camera> cameras = {every_field_set(), rows, parse_camera_toml(documented)};
  for (const std::string& name : built_in_camera_names()) cameras.push_back(built_in_camera(name));
  for (const Camera& camera : cameras)
    EXPECT_EQ(parse_camera_toml(camera_to_toml(camera)), camera) << camera_to_toml(camera);
}

TEST(CameraToml, JsonHoldsTheSameFields) {
  const auto json = nlohmann::json::parse(camera_to_json(every_field_set()));
  EXPECT_EQ(json["exposure_s"], (std::vector<double>{0.1, 1.0 / 7}));
  EXPECT_EQ(json["sensor"]["impulse_response"]["kind"], "file");
  EXPECT_EQ(json["operating"]["albedo"], "uniform");
  EXPECT_EQ(json["sensor"]["adc_bits"], 12);
}

TEST(CameraToml, AnInvalidCameraIsNotWritten) {
  Camera camera = built_in_camera("paper-5f0");
  camera.exposure_s.total_s = -1;
  EXPECT_THROW(camera_to_toml(camera), std::invalid_argument);
  camera = built_in_camera("paper-5f0");
  camera.name = "\xff";
  EXPECT_THROW(camera_to_toml(camera), std::invalid_argument);
}

struct BadLine {
  const char* line;
  const char* message;
};

class CameraTomlRefuses : public testing::TestWithParam<BadLine> {};

TEST_P(CameraTomlRefuses, WithPlaceAndWhatWasExpected) {
  EXPECT_EQ(refusal(with_line(GetParam().line)), std::string("c.toml:") + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Lines, CameraTomlRefuses,
    testing::Values(
        BadLine{"[lihgt]", "2:2: unknown key lihgt; did you mean light?"},
        BadLine{"[lens]\nzzzzzz = 1\nfx_px=1\nfy_px=1\ncx_px=1\ncy_px=1",
                "3:1: unknown key lens.zzzzzz; expected rays, calibration, calibration_camera, "
                "fx_px, fy_px, cx_px, cy_px, distortion_model, distortion, distortion_max_radius, "
                "width_px, height_px, frame_modes, blur, blur_sigma_px, focal_length_m, f_number, "
                "focus_distance_m, pixel_pitch_m, pixel_samples"},
        BadLine{"sensor.readout_gap_s = -1e-3",
                "2:24: sensor.readout_gap_s = -0.001; must be finite and >= 0"},
        BadLine{"sensor.frame_period_s = 0",
                "2:25: sensor.frame_period_s = 0; must be finite and > 0"},
        BadLine{"samples = 240.5", "2:11: samples: found 240.5; expected an integer"},
        BadLine{"samples = 99999999999",
                "2:11: samples: found 99999999999; expected an integer of at most 32 bits"},
        BadLine{"light = 3", "2:9: light: found 3; expected a table"},
        BadLine{"name = 3", "2:8: name: found 3; expected a text in quotes"},
        BadLine{"exposure_s = \"0.3\"",
                "2:14: exposure_s: found \"0.3\"; expected a number or a list of numbers"},
        BadLine{"exposure_s = []",
                "2:14: exposure_s: found an empty list; expected at least one number"},
        BadLine{"exposure_s = [0.1, true]", "2:20: exposure_s[1]: found true; expected a number"},
        BadLine{"exposure_s = inf", "2:14: exposure_s: found inf; expected a finite number"},
        BadLine{"exposure_s = [0.1, nan]",
                "2:20: exposure_s[1]: found nan; expected a finite number"},
        BadLine{"light.binary = 1", "2:16: light.binary: found 1; expected true or false"},
        BadLine{"operating.signal_e_per_s = 1e3",
                "2:28: operating.signal_e_per_s: found 1000.0; expected a list of numbers"},
        BadLine{"operating.albedo = \"unifrom\"",
                "2:20: operating.albedo: found \"unifrom\"; expected a number or \"uniform\""},
        BadLine{"sensor.readout = \"diference\"",
                "2:18: sensor.readout: found \"diference\"; expected one of \"separate\", "
                "\"difference\", \"rows\"; did you mean \"difference\"?"},
        BadLine{"light.peak_factor = 0.5",
                "2:21: light.peak_factor = 0.5; must be finite and >= 1: the peak is never below "
                "the average"},
        BadLine{"operating.ambient_e_per_s = []",
                "2:29: operating.ambient_e_per_s = []; must list at least one level"},
        BadLine{
            "sensor.modulation_contrast = 0.5",
            "2:30: sensor.modulation_contrast = 0.5; must be 1 for one tap: contrast mixes taps"},
        BadLine{"sensor.taps = 2\nsensor.modulation_contrast = [1, 1.5]",
                "3:30: sensor.modulation_contrast[1] = 1.5; must be in (0, 1]"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1 }",
                "2:8: found no lens.cy_px; expected a line such as `cy_px = 239.5`"},
        BadLine{"samples = 8 8",
                "2:13: Error while parsing key-value pair: expected a comment or whitespace, saw "
                "'8'"}));

INSTANTIATE_TEST_SUITE_P(
    Responses, CameraTomlRefuses,
    testing::Values(
        BadLine{"light.impulse_response = { kind = \"none\", f_max_hz = 1e8 }",
                "2:54: light.impulse_response.f_max_hz: is only valid with kind = \"hann\""},
        BadLine{"light.impulse_response = { kind = \"hann\", f_max_hz = 1e8, cutoff_hz = 1e8 }",
                "2:71: light.impulse_response.cutoff_hz: is only valid with kind = \"gaussian\" or "
                "\"lowpass\""},
        BadLine{"light.impulse_response = { kind = \"lowpass\", cutoff_hz = 1e8, file = \"a\" }",
                "2:70: light.impulse_response.file: is only valid with kind = \"file\""},
        BadLine{"light.impulse_response = { kind = \"hann\" }",
                "2:26: found no light.impulse_response.f_max_hz; expected a line such as `f_max_hz "
                "= 150e6`"},
        BadLine{"light.impulse_response = { f_max_hz = 1e8 }",
                "2:26: found no light.impulse_response.kind; expected a line such as `kind = "
                "\"hann\"`"},
        BadLine{"[sensor.impulse_response]\nkind = \"gaussian\"\ncutoff_hz = -1",
                "4:13: sensor.impulse_response.cutoff_hz = -1; must be finite and > 0"},
        BadLine{"light.impulse_response = { kind = \"file\", time_step_s = 1e-9 }",
                "2:26: found no light.impulse_response.samples; expected a line such as `samples = "
                "[0.1, 0.5, 0.3, 0.1]`"},
        BadLine{
            "light.impulse_response = { kind = \"file\", file = \"a.csv\", samples = [1] }",
            "2:69: light.impulse_response.samples: is only valid with kind = \"file\" and no file"},
        BadLine{"light.impulse_response = { kind = \"file\", samples = [1, 2] }",
                "2:26: found no light.impulse_response.time_step_s; expected a line such as "
                "`time_step_s = 1e-9`"}));

INSTANTIATE_TEST_SUITE_P(
    Operating, CameraTomlRefuses,
    testing::Values(
        BadLine{"[operating.multipath]\nratio = [0.5, 0.1]",
                "3:9: operating.multipath.ratio = [0.5, 0.1]; must be [min, max] with min <= max"},
        BadLine{"[operating.multipath]\ndelay_m = [1, 8]",
                "3:11: operating.multipath.delay_m = [1, 8]; must be [shortest, longest] with "
                "shortest <= longest and below the unambiguous range, 7.495 m"},
        BadLine{"[operating.interference]\ncode = \"other\"",
                "3:8: operating.interference.code = other; must be \"same\" or the name of a "
                "family such as sinusoid-k4"},
        BadLine{"operating.depths = []",
                "2:20: operating.depths = []; must list at least one weight"},
        BadLine{"operating.depths = [0, 0]",
                "2:20: operating.depths = weights that are all 0; must have one > 0"},
        BadLine{"operating.depths = [1, -2]",
                "2:20: operating.depths[1] = -2; must be finite and >= 0"},
        BadLine{"operating.working_distance_m = 3",
                "2:32: operating.working_distance_m: found 3; expected a list of two numbers"},
        BadLine{"operating.working_distance_m = [1, 8]",
                "2:32: operating.working_distance_m = [1, 8]; must be [nearest, farthest] with "
                "nearest < farthest <= the unambiguous range, 7.49481 m"}));

TEST(CameraToml, TooManyDepthWeightsAreRejected) {
  std::string list = "1";
  for (int i = 0; i < 10000; ++i) list += ",1";
  EXPECT_EQ(refusal(std::string(shortest) + "operating.depths = [" + list + "]"),
            "c.toml:2:20: operating.depths = 10001 weights; must be at most 10000, one for each "
            "equal part of the working distance or range");
}

TEST(CameraToml, ReportsWhereInvalidTomlEnds) {
  EXPECT_THAT(refusal("fundamental_frequency_hz = 15e6\n\n[light\n"), HasSubstr("c.toml:3:7: "));
  EXPECT_THAT(refusal("a = 1\na = 2\n"), HasSubstr("c.toml:2:"));
}

TEST(CameraToml, SyntaxErrorsComeWithTheirLikelyCause) {
  EXPECT_THAT(
      refusal("fundamental_frequency_hz = 20 MHz\n"),
      HasSubstr("a number with a unit needs quotes: fundamental_frequency_hz = \"20 MHz\""));
  EXPECT_THAT(refusal("exposure_s = 0,02\n"), HasSubstr("decimals have a point"));
  EXPECT_THAT(refusal("name = my camera  # of the lab\n"),
              HasSubstr("text needs quotes: name = \"my camera\""));
  EXPECT_THAT(refusal("samples = 240 px\n"), HasSubstr("samples is a plain number"));
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0\1\2",
                                  7)),
              HasSubstr("this is a binary file"));
}

TEST(CameraToml, NumbersMayHaveTheirUnit) {
  const Camera camera = parse_camera_toml(
      "fundamental_frequency_hz = \"20 MHz\"\nexposure_s = \"5ms\"\nsamples = 1.2e2\n", "c.toml",
      std::vector<std::string>{"sensor.impulse_response={kind=\"lowpass\", cutoff_hz=\"80MHz\"}",
                               "exposure_s=2 ms"});
  EXPECT_DOUBLE_EQ(camera.fundamental_frequency_hz, 20e6);
  EXPECT_DOUBLE_EQ(camera.exposure_s.total_s, 2e-3);
  EXPECT_EQ(camera.samples, 120);
  EXPECT_THAT(refusal("fundamental_frequency_hz = \"20 kg\"\n"), HasSubstr("expected a number"));
}

TEST(CameraToml, UnknownKeysAreNamedBeforeMissingOnes) {
  EXPECT_THAT(refusal("fundamental_freqency_hz = 15e6\n"),
              HasSubstr("did you mean fundamental_frequency_hz?"));
  EXPECT_THAT(refusal("fundamental_frequency_hz = 15e6\nexposure_ms = 20\n"),
              HasSubstr("did you mean exposure_s, in s?"));
}

TEST(CameraToml, KeysOfTooManyPartsAreRejected) {
  std::string key = "a";
  for (int i = 0; i < 200000; ++i) key += ".a";
  for (const std::string& text : {key + " = 1", "[" + key + "]", "x = { " + key + " = 1 }",
                                  "# a comment\n\"a.b\"." + key + " = 1"})
    EXPECT_THAT(refusal(text), HasSubstr("parts between dots"));
  EXPECT_THAT(refusal("", {key + "=1"}), HasSubstr("parts between dots"));
  const std::string dots(300, '.');
  EXPECT_EQ(parse_camera_toml("fundamental_frequency_hz = 15e6  # " + dots + "\nname = \"" + dots +
                                  "\"\n[light]\npeak_factor = 5.0",
                              "c.toml")
                .name,
            dots);
}

TEST(CameraSettings, AreAppliedBeforeValidation) {
  const std::vector<std::string> settings = {
      "samples=120",
      "light.peak_factor = 5",
      "exposure_s=[0.1, 0.2]",
      "sensor.taps=2",
      "sensor.readout=difference",
      "operating.albedo=\"uniform\"",
      "sensor.impulse_response={kind=\"none\"}",
      "light.impulse_response.f_max_hz=75e6",
      "sensor={read_noise_e=3}",
      "sensor.taps=4",
  };
  const Camera camera = parse_camera_toml(documented, "c.toml", settings);
  EXPECT_EQ(camera.samples, 120);
  EXPECT_EQ(camera.light.peak_factor, 5.0);
  EXPECT_THAT(camera.exposure_s.each_s, ElementsAre(0.1, 0.2));
  EXPECT_TRUE(camera.operating.uniform_albedo);
  EXPECT_EQ(camera.light.impulse_response.kind, Kind::hann) << "other keys of a table stay";
  EXPECT_EQ(camera.light.impulse_response.f_max_hz, 75e6);
  EXPECT_EQ(camera.sensor.impulse_response.kind, Kind::none) << "braces replace the table";
  EXPECT_EQ(camera.sensor.readout, Readout::separate);
  EXPECT_EQ(camera.sensor.taps, 4) << "the last one counts";
  EXPECT_EQ(camera.light.binary, true);
}

TEST(CameraSettings, CanCompleteAFile) {
  const std::vector<std::string> settings = {"fundamental_frequency_hz=10e6"};
  EXPECT_EQ(parse_camera_toml("", "c.toml", settings).fundamental_frequency_hz, 10e6);
}

TEST(CameraSettings, WithoutAValueRemoveTheKey) {
  const Camera bare = built_in_camera("paper-10f0");
  const std::vector<std::string> full = {"sensor.full_well_e=3e4", "sensor.shortest_pulse_s=1e-8"};
  const Camera with_both = with_settings(bare, full);
  const std::vector<std::string> out = {"sensor.full_well_e=", " sensor.shortest_pulse_s = "};
  EXPECT_EQ(with_settings(with_both, out), bare);
  const std::vector<std::string> table = {"light.impulse_response="};
  EXPECT_EQ(with_settings(bare, table).light.impulse_response.kind, ImpulseResponse::Kind::none);
  EXPECT_EQ(refusal(std::string(documented), {"light.peak_facter="}),
            "setting 'light.peak_facter=': found no key light.peak_facter to remove; did you mean "
            "peak_factor?");
  EXPECT_THAT(refusal(std::string(documented), {"samples.light="}),
              HasSubstr("found no key samples.light to remove"));
  EXPECT_THAT(refusal(std::string(documented), {"fundamental_frequency_hz="}),
              HasSubstr("fundamental_frequency_hz"));
}

TEST(CameraSettings, AreReportedInErrorMessages) {
  const auto broken_by = [](const std::string& setting) {
    return refusal(std::string(documented), {setting});
  };
  EXPECT_EQ(broken_by("light.peak_facter=5"),
            "setting 'light.peak_facter=5': unknown key light.peak_facter; did you mean "
            "light.peak_factor?");
  EXPECT_EQ(broken_by("light.peak_factor=half"),
            "setting 'light.peak_factor=half': light.peak_factor: found \"half\"; expected a "
            "number");
  EXPECT_EQ(broken_by("samples=4"), "setting 'samples=4': samples = 4; must be in [8, 65536]");
  EXPECT_EQ(broken_by("light.impulse_response.kind=none"),
            "c.toml:8:48: light.impulse_response.f_max_hz: is only valid with kind = "
            "\"hann\"");
  EXPECT_THAT(broken_by("samples"), HasSubstr("setting 'samples': "));
  EXPECT_THAT(broken_by("samples=1 2"), HasSubstr("expected key = value"));
  EXPECT_THAT(broken_by(""), HasSubstr("setting '': found no key; expected key = value"));
  std::string list = "operating.depths=[1";
  for (int i = 0; i < 5000; ++i) list += ",1";
  EXPECT_EQ(broken_by(list + ",-1]"), "setting '" + list.substr(0, 160) +
                                          "..': operating.depths[5001] = -1; must be finite "
                                          "and >= 0");
  EXPECT_THAT(broken_by("=5"), HasSubstr("expected key = value"));
}

TEST(CalibratedCamera, IsReadBackWithItsOptionalTables) {
  Camera camera = built_in_camera("indoor");
  EXPECT_EQ(parse_camera_toml(calibrated_camera_toml(camera)), camera);
  camera.name = "mine";
  EXPECT_EQ(parse_camera_toml(calibrated_camera_toml(camera)), camera);
  camera.light.generator.emplace();
  camera.operating.multipath.emplace();
  camera.operating.interference.emplace();
  camera.playback.emplace();
  camera.temperature.emplace().sensor.emplace();
  EXPECT_EQ(parse_camera_toml(calibrated_camera_toml(camera)), camera);
}

TEST(LoadCamera, AcceptsABuiltInNameOrAFile) {
  EXPECT_EQ(load_camera("paper-10f0"), built_in_camera("paper-10f0"));
  const TemporaryDirectory directory;
  std::ofstream(directory / "mine.toml") << shortest;
  const std::vector<std::string> settings = {"samples=64"};
  EXPECT_EQ(load_camera((directory / "mine.toml").string(), settings).samples, 64);
  EXPECT_EQ(load_camera("paper-10f0", settings).samples, 64);
  EXPECT_THAT(io_error_of([] { load_camera("paper-10fo"); }),
              AllOf(HasSubstr("paper-10fo: there is no such file and no built-in camera of that "
                              "name (indoor, paper-30x, "),
                    HasSubstr("did you mean paper-10f0?")));
}

TEST(LoadCamera, ResponsesAreFoundNextToTheFile) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "response.csv") << "time_s,value\n0,1\n1e-9,2\n2e-9,1\n";
  std::ofstream(directory / "c.toml")
      << shortest << "light.impulse_response = { kind = \"file\", file = \"response.csv\" }\n";
  const Camera camera = read_camera_toml(directory / "c.toml");
  EXPECT_THAT(camera.light.impulse_response.samples, ElementsAre(1.0, 2.0, 1.0));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), "elsewhere/c.toml"), camera);
}

TEST(CameraToml, EveryPrefixIsReadOrRejected) {
  for (std::size_t length = 0; length < documented.size(); ++length) {
    const std::string part(documented.substr(0, length));
    try {
      parse_camera_toml(part, "c.toml");
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("c.toml:"));
    }
  }
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/upload_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "refusal.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

QuantizedWaveform ramp(const GeneratorModel& model, Arm arm, int index) {
  constexpr int points = 48;
  QuantizedWaveform waveform;
  waveform.name = (arm == Arm::light ? "modulation_" : "demodulation_") + std::to_string(index + 1);
  waveform.arm = arm;
  waveform.index = index;
  waveform.levels = waveform_format(model.format()).levels;
  const int slope = 2 * index + (arm == Arm::light ? 1 : 2);
  for (int i = 0; i < points; ++i) waveform.codes.push_back(slope * i);
  waveform.sample_rate_hz = 123456.7 * points;
  waveform.low_v = arm == Arm::light ? 0.0 : -0.25;
  waveform.high_v = arm == Arm::light ? 1.5 : 0.75;
  return waveform;
}

/// Two exposures in memory, the second selected.
UploadRequest example_request(const GeneratorModel& model) {
  UploadRequest request;
  for (const Arm arm : {Arm::light, Arm::sensor})
    request.channels.push_back(
        {arm == Arm::light ? 1 : 2, {ramp(model, arm, 0), ramp(model, arm, 1)}, 1});
  return request;
}

TEST(UploadScript, RejectsRequestsThatDoNotSuitTheModel) {
  const auto problem = [](const char* model, auto change) {
    UploadRequest request = example_request(generator_model(model));
    change(request);
    return refusal_of([&] { upload_script(generator_model(model), request); });
  };
  const auto resize = [](int points) {
    return [points](UploadRequest& r) { r.channels[0].stored[0].codes.resize(points, 0); };
  };
  EXPECT_THAT(problem("SDG1032X", resize(16385)),
              HasSubstr("modulation_1 points = 16385; must be"));
  EXPECT_THAT(problem("33612", resize(31)), HasSubstr("points = 31; must be in [32, 4000000]"));
  EXPECT_THAT(problem("AFG3021", [](UploadRequest&) {}),
              HasSubstr("channel = 2; must be in [1, 1]"));
  EXPECT_THAT(problem("33522", [](UploadRequest& r) { r.channels[1].channel = 1; }),
              HasSubstr("must be different for light and sensor"));
  EXPECT_THAT(problem("33522", [](UploadRequest& r) { r.channels[0].stored[1].high_v = 5.5; }),
              HasSubstr("modulation_2 volts = 5.5; must be at most 5 from zero"));
  EXPECT_THAT(problem("AFG3022", [](UploadRequest& r) { r.channels[0].stored[1].high_v = 0.01; }),
              HasSubstr("amplitude_vpp = 0.01; must be in [0.02, 10]"));
  EXPECT_THAT(
      problem("33522", [](UploadRequest& r) { r.channels[0].stored[0].sample_rate_hz = 251e6; }),
      HasSubstr("sample_rate_hz = 2.51e+08; must be at most 2.5e+08"));
  EXPECT_THAT(problem("SDG1032X",
                      [](UploadRequest& r) { r.channels[0].stored[0].sample_rate_hz = 48 * 7e6; }),
              HasSubstr("repetition_hz = 7e+06; must be at most 6e+06"));
  EXPECT_THAT(
      problem("AFG3022",
              [](UploadRequest& r) { r.channels[0].stored.resize(4, r.channels[0].stored[0]); }),
      HasSubstr("waveforms = 6; must be at most 4"));
  EXPECT_THAT(problem("33522", [](UploadRequest& r) { r.true_arb = true; }),
              HasSubstr("true_arb = on; must be off"));
  EXPECT_THAT(problem("33522", [](UploadRequest& r) { r.load_ohm = 0.0; }), HasSubstr("load_ohm"));
}

TEST(UploadScript, TextShowsEveryMessage) {
  const GeneratorModel& model = generator_model("AFG3022");
  const std::string text = script_text(upload_script(model, example_request(model)));
  for (const char* line :
       {"OUTP1 OFF  # switch outputs off\n", "TRAC:DATA EMEM,<100 bytes>  # load modulation_1\n",
        "TRAC:COPY USER1,EMEM", "TRAC:DATA? EMEM", "SOUR2:FUNC USER4", "SOUR1:FREQ 123456.7 ",
        "SOUR2:VOLT:OFFS 0.25 "})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_EQ(text.find("OUTP1 ON"), std::string::npos);
}

TEST(GeneratorModel, IsFoundByTheReportedModelName) {
  const auto name = [](const char* reported) { return generator_model(reported).name; };
  EXPECT_EQ(name("SDG2042X"), "SDG2042X");
  EXPECT_EQ(name("33521A"), "33521");
  EXPECT_EQ(name("33622A"), "33622");
  EXPECT_EQ(name("AFG3252C"), "AFG3252");
  for (const char* other : {"DG4062", "SDS1104X", "AFG31022", "34465A", ""})
    EXPECT_EQ(find_generator_model(other), nullptr) << other;
  EXPECT_THAT([] { generator_model("SDG2024X"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("did you mean SDG2042X?")));
}

ExportedScripts scripts_of(const ExportOptions& options) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  return export_scripts(export_waveforms(code, exporting_camera(code, camera, options), options));
}

TEST(ExportScripts, ModelsWithEqualMessagesShareAScriptPerExposure) {
  const ExportedScripts siglent =
      scripts_of({.format = "siglent-wvdt16", .samples = 16, .periods = 4});
  std::vector<std::string> names;
  for (const ExportedScript& script : siglent.files) names.push_back(script.name);
  EXPECT_THAT(names, ElementsAre("SDG1032X_exposure_1.scpi.txt", "SDG2042X_exposure_1.scpi.txt",
                                 "SDG1032X_exposure_2.scpi.txt", "SDG2042X_exposure_2.scpi.txt",
                                 "SDG1032X_exposure_3.scpi.txt", "SDG2042X_exposure_3.scpi.txt"));
  EXPECT_THAT(siglent.files[1].text, HasSubstr("SDG2122X, SDG6022X, SDG6032X, SDG6052X\n"));
  EXPECT_EQ(siglent.problem, "");
  const ExportedScripts tektronix = scripts_of({.format = "tek-tfw", .samples = 16, .periods = 4});
  ASSERT_EQ(tektronix.files.size(), 3u);
  EXPECT_THAT(tektronix.files[2].text, HasSubstr("# load demodulation_3\n"));
}

TEST(ExportScripts, EqualThoseOfAnUpload) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const ExportOptions options{.format = "keysight-arb", .samples = 16};
  const WaveformExport exported =
      export_waveforms(code, exporting_camera(code, camera, options), options);
  const std::string text = export_scripts(exported).files.at(1).text;
  UploadRequest request;
  request.channels = selected_channels(exported, {.exposure = 2});
  const std::string uploaded = script_text(upload_script(generator_model("33522"), request));
  EXPECT_EQ(text.substr(text.find('\n')), uploaded.substr(uploaded.find('\n')));
}

TEST(ExportScripts, ReportTheRuleIfNoModelSupportsTheTables) {
  const ExportedScripts none = scripts_of({.format = "keysight-arb", .samples = 100});
  EXPECT_TRUE(none.files.empty());
  EXPECT_THAT(none.problem, HasSubstr("sample_rate_hz = 1.5e+09; must be at most 1e+09"));
  EXPECT_EQ(scripts_of({.format = "csv", .samples = 100}).problem, "");
}

}  // namespace
}  // namespace tofsmith

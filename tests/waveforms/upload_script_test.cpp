// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/upload_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

QuantizedWaveform random_waveform(const GeneratorModel& model, Arm arm, int index) {
  constexpr int points = 48;
  QuantizedWaveform waveform;
  waveform.name = (arm == Arm::light ? "modulation_" : "demodulation_") + std::to_string(index + 1);
  waveform.arm = arm;
  waveform.index = index;
  waveform.levels = waveform_format(model.format()).levels;
  RandomStream random(17, static_cast<std::uint64_t>(index), arm == Arm::light ? 0 : 1);
  for (int i = 0; i < points; ++i)
    waveform.codes.push_back(
        static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(waveform.levels)));
  waveform.sample_rate_hz = 123456.7 * points;
  waveform.low_v = arm == Arm::light ? 0.0 : -0.25;
  waveform.high_v = arm == Arm::light ? 1.5 : 0.75;
  return waveform;
}

/// Light on channel 1 and sensor on channel 2, two exposures in memory, the second selected.
UploadRequest example_request(const GeneratorModel& model) {
  UploadRequest request;
  for (const Arm arm : {Arm::light, Arm::sensor})
    request.channels.push_back({arm == Arm::light ? 1 : 2,
                                {random_waveform(model, arm, 0), random_waveform(model, arm, 1)},
                                1});
  return request;
}

TEST(UploadScript, RefusesWhatDoesNotFitTheModel) {
  const auto problem = [](const char* model, auto change) -> std::string {
    UploadRequest request = example_request(generator_model(model));
    change(request);
    try {
      upload_script(generator_model(model), request);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
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
              HasSubstr("must be another for light and sensor"));
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

TEST(GeneratorModel, IsFoundByTheModelNameThatAnInstrumentReports) {
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

}  // namespace
}  // namespace tofsmith

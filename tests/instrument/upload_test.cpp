// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/upload.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "upload_setup.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

TEST(Upload, EveryFamilyPlaysWhatWasSent) {
  for (const FamilyExample& example : family_examples) {
    SCOPED_TRACE(example.answers);
    const GeneratorModel& model = generator_model(example.model);
    for (const bool on : {false, true}) {
      UploadRequest request = example_request(model);
      request.output_on = on;
      SimulatedGenerator generator(example.family, example.answers);
      const UploadReport report = upload_to(generator, upload_script(model, request), on);
      EXPECT_TRUE(report.verified);
      EXPECT_TRUE(plays(generator, request, model));
      EXPECT_FALSE(report.numbers.empty());
      for (const ReadBackNumber& number : report.numbers)
        EXPECT_NEAR(number.read_back, number.requested, 1e-5 * std::abs(number.requested) + 1e-3);
    }
  }
}

TEST(Upload, SiglentTakesItInThreeWaysAndAtAClockOfItsOwn) {
  const GeneratorModel& model = generator_model("SDG2042X");
  for (const WaveHeader header : {WaveHeader::length, WaveHeader::plain, WaveHeader::minimal}) {
    UploadRequest request = example_request(model);
    request.wave_header = header;
    SimulatedGenerator generator(SimulatedGenerator::Family::siglent, "SDG2042X");
    EXPECT_TRUE(upload_to(generator, upload_script(model, request)).verified);
    EXPECT_TRUE(plays(generator, request, model));
  }
  UploadRequest request = example_request(model);
  request.true_arb = true;
  request.load_ohm = std::numeric_limits<double>::infinity();
  SimulatedGenerator generator(SimulatedGenerator::Family::siglent, "SDG2042X");
  EXPECT_TRUE(upload_to(generator, upload_script(model, request)).verified);
  EXPECT_EQ(generator.channel(1).clock, "TARB");
  EXPECT_NEAR(generator.channel(1).sample_rate_hz, 123456.7 * 48, 10.0);
  EXPECT_GT(generator.channel(1).load_ohm, 1e8);
}

TEST(Upload, WithoutReadingPointsItIsNotVerifiedAndSaysSo) {
  for (const FamilyExample& example : family_examples) {
    const GeneratorModel& model = generator_model(example.model);
    UploadRequest request = example_request(model);
    request.read_back = false;
    SimulatedGenerator generator(example.family, example.answers);
    const UploadReport report = upload_to(generator, upload_script(model, request));
    EXPECT_FALSE(report.verified);
    EXPECT_THAT(report.message, HasSubstr("unverified"));
    EXPECT_TRUE(plays(generator, request, model));
  }
}

TEST(Upload, RandomFaultsNeverLeaveAWrongWaveformThatCallsItselfVerified) {
  constexpr int runs_of_family = 500;
  int verified = 0, refused = 0;
  for (const FamilyExample& example : family_examples) {
    const GeneratorModel& model = generator_model(example.model);
    UploadRequest request = example_request(model, 24);
    UploadScript scripts[2];
    for (const bool on : {false, true}) {
      request.output_on = on;
      scripts[on ? 1 : 0] = upload_script(model, request);
    }
    SimulatedGenerator well(example.family, example.answers);
    upload_to(well, scripts[1]);
    for (int run = 0; run < runs_of_family; ++run) {
      RandomStream random(4, static_cast<std::uint64_t>(run));
      SimulatedGenerator generator(example.family, example.answers);
      const auto fault =
          static_cast<Fault>(1 + random() % static_cast<std::uint32_t>(fault_kinds - 1));
      const int message = static_cast<int>(random() % static_cast<std::uint32_t>(well.messages()));
      generator.set_fault(fault, message, random());
      request.output_on = run % 2 == 1;
      try {
        const UploadReport report =
            upload_to(generator, scripts[run % 2], fault == Fault::splits_answer);
        verified += report.verified ? 1 : 0;
        ASSERT_TRUE(report.verified);
        ASSERT_TRUE(plays(generator, request, model))
            << example.model << ", run " << run << ", fault " << static_cast<int>(fault)
            << " at message " << message;
      } catch (const IoError& error) {
        ++refused;
        ASSERT_THAT(error.what(), HasSubstr("tcp://simulated:5025: "));
      }
    }
  }
  EXPECT_EQ(verified + refused, 3 * runs_of_family);
  EXPECT_GT(refused, 2 * runs_of_family);
  EXPECT_GT(verified, 20);
  RecordProperty("verified", verified);
  RecordProperty("refused", refused);
}

TEST(Upload, AfterAFaultOutputsAreOff) {
  for (const FamilyExample& example : family_examples) {
    const GeneratorModel& model = generator_model(example.model);
    UploadRequest request = example_request(model, 24);
    request.output_on = true;
    const UploadScript script = upload_script(model, request);
    for (const Fault fault : {Fault::corrupts_point, Fault::other_value, Fault::answers_garbage,
                              Fault::swallows_answer, Fault::extra_line}) {
      SimulatedGenerator generator(example.family, example.answers);
      generator.set_fault(fault, 8, 77);
      EXPECT_THROW(upload_to(generator, script), IoError);
      EXPECT_FALSE(generator.channel(1).on || generator.channel(2).on);
    }
  }
}

TEST(Upload, StopsWhenAskedWithOutputsOff) {
  for (const FamilyExample& example : family_examples) {
    const GeneratorModel& model = generator_model(example.model);
    UploadRequest request = example_request(model);
    request.output_on = true;
    const UploadScript script = upload_script(model, request);
    for (const double at : {0.0, 0.3, 0.98}) {
      SimulatedGenerator generator(example.family, example.answers);
      const auto progress = [at](double fraction, std::string_view) { return fraction < at; };
      EXPECT_THROW(upload_to(generator, script, false, progress), Interrupted);
      EXPECT_FALSE(generator.channel(1).on || generator.channel(2).on);
    }
  }
}

TEST(Upload, AnErrorNamesTheStepWhatWasSentAndWhatCame) {
  const GeneratorModel& model = generator_model("33522");
  const UploadScript script = upload_script(model, example_request(model));
  SimulatedGenerator generator(SimulatedGenerator::Family::keysight, "33522B");
  generator.set_fault(Fault::other_value, 0, 1);
  EXPECT_EQ(problem_of([&] { upload_to(generator, script); }),
            "tcp://simulated:5025: check channel 1: sent 'OUTP1:LOAD?': channel 1 load_ohm: found "
            "51; expected 50, as was sent: the instrument does not take this value");
  SimulatedGenerator refuses(SimulatedGenerator::Family::keysight, "33522B");
  refuses.set_fault(Fault::reports_error, 6, 1);
  EXPECT_THAT(problem_of([&] { upload_to(refuses, script); }),
              HasSubstr("the instrument reports the error -222,\"Data out of range\""));
}

TEST(Upload, RefusesWhatDoesNotFitTheModel) {
  const auto problem = [](const char* model, auto change) {
    UploadRequest request = example_request(generator_model(model));
    change(request);
    return problem_of([&] { upload_script(generator_model(model), request); });
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

TEST(Upload, ADryRunShowsEveryMessage) {
  const GeneratorModel& model = generator_model("AFG3022");
  const std::string text = script_text(upload_script(model, example_request(model)));
  for (const char* line :
       {"OUTP1 OFF  # switch outputs off\n", "TRAC:DATA EMEM,<100 bytes>  # load modulation_1\n",
        "TRAC:COPY USER1,EMEM", "TRAC:DATA? EMEM", "SOUR2:FUNC USER4", "SOUR1:FREQ 123456.7 ",
        "SOUR2:VOLT:OFFS 0.25 "})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_EQ(text.find("OUTP1 ON"), std::string::npos);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "sweep_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string base = "camera = \"paper-10f0\"\nset = [\"samples=24\"]\ntrials = 16\n";

std::string key_of(const std::string& text) {
  return WorkList(parse_sweep_toml(base + "code = \"square-k4\"\n" + text)).item(0).key;
}
std::string axis(const std::string& key, const std::string& value) {
  return "[[axis]]\nkey = \"" + key + "\"\nvalues = [" + value + "]\n";
}

TEST(WorkList, AKeyDependsOnEverythingThatAffectsTheResult) {
  const std::vector<std::string> texts = {
      "",
      axis("seed", "2"),
      axis("trials", "18"),
      axis("method", "\"ml\""),
      axis("method", "\"unwrap\""),
      axis("method", "\"unwrap\"") + axis("unwrap_weights", "\"frequency\""),
      axis("signal_e_per_s", "5e3"),
      axis("ambient_e_per_s", "5e3"),
      axis("samples", "48"),
      axis("light.peak_factor", "12"),
      axis("sensor.read_noise_e", "5"),
      axis("light.impulse_response.f_max_hz", "1e8"),
      axis("operating.depths", "[0, 1, 2]"),
      axis("operating.depths", "[0, 1, 3]"),
      axis("operating.working_distance_m", "[1, 3]"),
      axis("operating.working_distance_m", "[1, 4]"),
      "outlier_threshold_m = 0.25\n",
      "sub_bin = false\n",
      "depth = \"bins\"\n",
      "clip_to_open_sensor = true\n",
      "draw_every_measurement = true\n",
      "bounds = false\n",
      "target_standard_error = 0.01\n",
      "target_standard_error = 0.01\nmax_trials = 1000\n"};
  std::set<std::string> keys;
  for (const std::string& text : texts) keys.insert(key_of(text));
  EXPECT_EQ(keys.size(), texts.size());
}

TEST(WorkList, TheKeyOfADesignedCodeDependsOnAllDesignSettings) {
  const std::string designed = "camera = \"paper-10f0\"\nset = [\"samples=24\"]\ntrials = 1000\n";
  const std::vector<std::string> texts = {
      "code = \"optimized-k3\"\n",
      "code = \"optimized-k4\"\n",
      "code = \"optimized-k3\"\neffort = 0.1\n",
      "code = \"optimized-k3\"\n" + axis("seed", "2"),
      "code = \"optimized-k3\"\n" + axis("operating.multipath", "{ratio = [0.1, 0.2]}"),
      "code = \"optimized-k3\"\n" + axis("operating.interference", "{cameras = 2}"),
      "code = \"optimized-k3\"\n" + axis("sensor.taps", "2")};
  std::set<std::string> keys;
  for (const std::string& text : texts) {
    const WorkList list(parse_sweep_toml(designed + text));
    const WorkItem item = list.item(0);
    EXPECT_FALSE(item.code);
    ASSERT_TRUE(item.design);
    EXPECT_EQ(list.keys().front(), item.key);
    keys.insert(item.key);
  }
  EXPECT_EQ(keys.size(), texts.size());
}

TEST(WorkList, TheKeyOfADesignedCodeDependsOnEveryKeyOfTheOperatingTable) {
  const std::map<std::string, std::string> other_values = {
      {"operating.signal_e_per_s", "[1e3]"},
      {"operating.ambient_e_per_s", "[1e3]"},
      {"operating.error", "\"circular\""},
      {"operating.statistic", "\"rmse\""},
      {"operating.albedo", "0.5"},
      {"operating.neighbours", "9"},
      {"operating.working_distance_m", "[1, 3]"},
      {"operating.depths", "[0, 1, 2]"},
      {"operating.velocity_m_per_s", "1"},
      {"operating.multipath.ratio", "[0.1, 0.2]"},
      {"operating.multipath.delay_m", "[0.1, 0.2]"},
      {"operating.multipath.weight", "0.3"},
      {"operating.interference.cameras", "2"},
      {"operating.interference.signal_ratio", "0.2"},
      {"operating.interference.code", "\"square-k4\""},
      {"operating.interference.frequency_offset_hz", "1e4"},
      {"operating.interference.spreading", "\"signs\""},
      {"operating.interference.parts", "8"}};
  const std::string designed =
      "camera = \"paper-10f0\"\ncode = \"optimized-k3\"\ntrials = 1000\nset = [\"samples=24\", "
      "\"operating.multipath.weight=0.2\", \"operating.interference.spreading=phases\"]\n";
  std::set<std::string> keys = {WorkList(parse_sweep_toml(designed)).item(0).key};
  std::size_t declared = 0;
  for (const KeyDescription& key : describe_camera_keys(load_camera("paper-10f0"))) {
    if (!key.name.starts_with("operating.") || key.type == ValueType::table) continue;
    ++declared;
    ASSERT_TRUE(other_values.contains(key.name)) << key.name << " needs a value in this test";
    keys.insert(WorkList(parse_sweep_toml(designed + axis(key.name, other_values.at(key.name))))
                    .item(0)
                    .key);
    EXPECT_EQ(keys.size(), declared + 1) << key.name;
  }
  EXPECT_EQ(declared, other_values.size());
}

TEST(WorkList, AKeyIgnoresSettingsWithoutEffect) {
  EXPECT_EQ(key_of(""), key_of("seed = 1\n"));
  EXPECT_EQ(key_of(""), key_of(axis("name", "\"other\"")));
  EXPECT_EQ(key_of(""), key_of("max_trials = 1000\n"));  // only used with a target
  EXPECT_EQ(key_of(""), key_of(axis("unwrap_weights", "\"frequency\"")));
  EXPECT_EQ(key_of(""), key_of(axis("operating.depths", "[2, 2]")));  // uniform depths
  EXPECT_EQ(key_of(axis("outlier_threshold_m", "0.25")), key_of("outlier_threshold_m = 0.25\n"));
  EXPECT_EQ(key_of(axis("signal_e_per_s", "5e3")), key_of(axis("signal_e_per_s", "5000, 1")));
}

TEST(WorkList, AKeyDependsOnWaveformsButNotOnTheCodesName) {
  const TemporaryDirectory directory;
  const WorkList family(parse_sweep_toml(base + "code = \"square-k4\"\n"));
  const CodeSet code = *family.item(0).code;
  const auto key_of_file = [&](const CodeSet& written) {
    write_code(directory / "mine.code.json", written, OutputPolicy::overwrite);
    return WorkList(parse_sweep_toml(base + "code = \"mine.code.json\"\n",
                                     (directory / "s.toml").string()))
        .item(0)
        .key;
  };
  EXPECT_EQ(key_of_file(code.renamed("mine")), family.item(0).key);
  EXPECT_NE(key_of_file(code.rotated(1)), family.item(0).key);
  ASSERT_EQ(code.exposures(), 4);
  EXPECT_NE(key_of_file(code.with_exposure_shares({0.4, 0.2, 0.2, 0.2})), family.item(0).key);
}

TEST(WorkList, AKeyDependsOnTheSamplesOfAMeasuredResponse) {
  const TemporaryDirectory directory;
  const auto key_with = [&](const std::string& file, const std::string& samples) {
    std::ofstream(directory / file) << samples;
    return key_of(axis("light.impulse_response", "{kind = \"file\", time_step_s = 1e-9, file = \"" +
                                                     (directory / file).string() + "\"}"));
  };
  const std::string key = key_with("a.csv", "0.5\n1\n0.5\n");
  EXPECT_EQ(key_with("b.csv", "0.5\n1\n0.5\n"), key);
  EXPECT_NE(key_with("a.csv", "0.5\n1\n0.25\n"), key);
}

TEST(WorkList, AddingValuesKeepsTheKeysOfTheOthers) {
  const std::vector<std::string> few = small_list("12, 15").keys();
  const std::vector<std::string> many = small_list("10, 12, 13, 15").keys();
  const std::set<std::string> kept(many.begin(), many.end());
  EXPECT_EQ(kept.size(), many.size());
  for (const std::string& key : few) EXPECT_TRUE(kept.contains(key));
}

TEST(WorkList, KeysOfTheListEqualThoseOfItsItems) {
  const std::string codes = "codes = [\"square-k4\", \"sinusoid-k4\"]\n";
  for (const std::string& text :
       {codes + axis("seed", "1, 2") + axis("light.peak_factor", "12, 15") +
            axis("signal_e_per_s", "1e3, 2.1e4") + axis("ambient_e_per_s", "0, 0.3"),
        codes + axis("method", "\"zncc\", \"ml\"") + axis("trials", "2, 4"),
        codes + axis("sub_bin", "true, false") + axis("outlier_threshold_m", "0.25, \"20 cm\""),
        codes + axis("operating.signal_e_per_s", "[1e3], [2e3]") + axis("signal_e_per_s", "5e3"),
        codes + axis("signal_e_per_s", "5e3, 6e3") + axis("operating.signal_e_per_s", "[1e3]"),
        "combine = \"zip\"\n" + codes + axis("samples", "24, 48") + axis("seed", "7, 8")}) {
    const WorkList list(parse_sweep_toml(base + text));
    const std::vector<std::string> keys = list.keys();
    ASSERT_EQ(list.size(), static_cast<std::int64_t>(keys.size()));
    for (std::size_t i = 0; i < keys.size(); ++i)
      EXPECT_EQ(keys[i], list.item(static_cast<std::int64_t>(i)).key) << text << i;
  }
}

TEST(WorkList, LinkedKeysGiveTheItemsOfEachSeparateSet) {
  const std::string band =
      "[[axis]]\nkeys = [\"light.impulse_response.f_max_hz\", "
      "\"sensor.impulse_response.f_max_hz\"]\nvalues = [[1e8, 2e8]]\n";
  EXPECT_EQ(key_of(band), key_of(axis("light.impulse_response.f_max_hz", "1e8") +
                                 axis("sensor.impulse_response.f_max_hz", "2e8")));
  EXPECT_EQ(WorkList(parse_sweep_toml(base + "code = \"square-k4\"\n" + band)).settings_json(0),
            R"({"code":"square-k4","light.impulse_response.f_max_hz":100000000,)"
            R"("sensor.impulse_response.f_max_hz":200000000})");
}

TEST(WorkList, ExposuresAreInsertedIntoTheNameOfAFamily) {
  const WorkList list(
      parse_sweep_toml(base + "code = \"hamiltonian-k{exposures}\"\n" + axis("exposures", "4, 3")));
  EXPECT_EQ(list.code_name(1), "hamiltonian-k3");
  EXPECT_EQ(list.item(1).code->exposures(), 3);
  EXPECT_EQ(list.settings_json(0), R"({"code":"hamiltonian-k4","exposures":4})");
}

TEST(WorkList, RejectsImpossibleItemsWithTheOffendingValue) {
  const auto refuse = [](const std::string& text, const char* place, const char* problem) {
    EXPECT_THAT([&] { WorkList(parse_sweep_toml(text, "s.toml")).keys(); },
                ThrowsMessage<IoError>(AllOf(testing::StartsWith(place), HasSubstr(problem))));
  };
  const std::string code = "code = \"square-k4\"\n";
  refuse(code + axis("light.peak_factor", "5, 0.5"), "s.toml:4:14", "(in item 2 of 2: ");
  refuse(code + axis("samples", "\"many\""), "s.toml:4:11", "expected an integer");
  refuse("code = \"sqare-k4\"\n", "s.toml: ", "did you mean square-k4?");
  refuse("code = \"optimized-k4\"\ntrials = 10\n", "s.toml: ", "must be in [1000, 100000000]");
  refuse("code = \"optimized-k4\"\nmethod = \"ml\"\n", "s.toml: ", "zncc to design codes");
  refuse("code = \"optimized-k0\"\n", "s.toml: ", "must be in [1, 16]");
  refuse(code + "effort = 0\n", "s.toml:2:10", "expected a number in [0.01, 100]");
  refuse("camera = \"paper\"\n" + code, "s.toml: ", "no built-in camera");
  refuse(code + "set = [\"samles=24\"]\n", "s.toml: setting 'samles=24'", "did you mean samples?");
}

}  // namespace
}  // namespace tofsmith

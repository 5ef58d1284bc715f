// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "german_locale.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Property;
using testing::StartsWith;
using testing::ThrowsMessage;

const std::string head = "code = \"square-k4\"\n";

SweepSpec with_axis(const std::string& axis) {
  return parse_sweep_toml(head + "[[axis]]\n" + axis, "s.toml");
}

std::vector<std::string> texts(const SweepAxis& axis) {
  std::vector<std::string> list;
  for (const SettingValue& value : axis.values) list.push_back(value.text);
  return list;
}

TEST(SweepSpec, ReadsValuesAsWritten) {
  const SweepSpec spec = with_axis("key = \"samples\"\nvalues = [120, 24, 60]\n");
  EXPECT_THAT(texts(spec.axes.at(0)), ElementsAre("120", "24", "60"));
  EXPECT_EQ(spec.axes[0].values[1].number, 24.0);
  EXPECT_EQ(spec.axes[0].values[1].place, "s.toml:4:16");
  EXPECT_THAT(texts(with_axis("key = \"exposure_s\"\nvalues = [[0.1, 0.2], 0.3]\n").axes[0]),
              ElementsAre("[0.1, 0.2]", "0.3"));
  EXPECT_EQ(with_axis("key = \"sensor.readout\"\nvalues = [\"separate\"]\n").axes[0].values[0].toml,
            "\"separate\"");
  EXPECT_EQ(with_axis("key = \"light.impulse_response\"\nvalues = [{kind = \"none\"}]\n")
                .axes[0]
                .values[0]
                .toml,
            "{ \"kind\" = \"none\" }");
}

TEST(SweepSpec, RangesEqualListsOfTheirValues) {
  EXPECT_THAT(texts(with_axis("key = \"exposure_s\"\nfrom = 0.1\nto = 0.5\nstep = 0.1\n").axes[0]),
              ElementsAre("0.1", "0.2", "0.3", "0.4", "0.5"));
  EXPECT_THAT(texts(with_axis("key = \"samples\"\nfrom = 60\nto = 30\nstep = -12\n").axes[0]),
              ElementsAre("60", "48", "36"));
  EXPECT_THAT(
      texts(with_axis("key = \"signal_e_per_s\"\nfrom = 1e3\nto = 1e5\ncount = 3\n").axes[0]),
      ElementsAre("1000", "10000", "100000"));
}

TEST(SweepSpec, RangesGiveTheSameValuesInEveryLocale) {
  const GermanLocale locale;
  EXPECT_THAT(texts(with_axis("key = \"exposure_s\"\nfrom = 0.1\nto = 0.3\nstep = 0.1\n").axes[0]),
              ElementsAre("0.1", "0.2", "0.3"));
}

/// Returns a sweep whose axis is the file peaks.txt with this content.
SweepSpec with_file(const TemporaryDirectory& directory, const std::string& content) {
  std::ofstream(directory / "peaks.txt") << content;
  std::ofstream(directory / "s.toml")
      << head << "[[axis]]\nkey = \"light.peak_factor\"\nfile = \"peaks.txt\"\n";
  return read_sweep_toml(directory / "s.toml");
}

TEST(SweepSpec, AFileHasOneValuePerLine) {
  const TemporaryDirectory directory;
  const SweepSpec spec = with_file(directory, "# peaks\n 5\n\n7.5 \r\n");
  EXPECT_THAT(texts(spec.axes.at(0)), ElementsAre("5", "7.5"));
  EXPECT_EQ(spec.axes[0].values[1].place, (directory / "peaks.txt").string() + ":4:1");
}

TEST(SweepSpec, AFileOfNumbersIsIndependentOfTheDialect) {
  const TemporaryDirectory directory;
  for (const char* text : {"5.5\n7\n",
                           "\xef\xbb\xbf"
                           "5,5\r\n7\r\n",
                           "5.5,\n7,\n", "\"5,5\";\n\"7\";\n", "peak_factor\n+5.5\n7\n",
                           "light.peak_factor\n5.5\n7\n"})
    EXPECT_THAT(texts(with_file(directory, text).axes.at(0)), ElementsAre("5.5", "7")) << text;
  EXPECT_THAT(io_error_of([&] { with_file(directory, "5\n9.91E+37\n"); }),
              testing::HasSubstr("peaks.txt:2:1: found 9.91E+37"));
}

TEST(SweepSpec, ErrorsDoNotQuoteOtherFiles) {
  const TemporaryDirectory directory;
  const std::string message =
      io_error_of([&] { with_file(directory, "root:x:0:0:root:/root:/bin/bash\n"); });
  EXPECT_THAT(message, testing::HasSubstr("peaks.txt:1:1: found a line that is not a value"));
  EXPECT_THAT(message, testing::Not(testing::HasSubstr("bash")));
}

TEST(SweepSpec, AProductHasEveryPairAndItsLastAxisIsFastest) {
  const std::string axes =
      "[[axis]]\nkey = \"samples\"\nvalues = [24, 30]\n[[axis]]\nkey = \"seed\"\nvalues = [1, 2]\n";
  const SweepSpec product = parse_sweep_toml("codes = [\"a\", \"b\", \"c\"]\n" + axes);
  EXPECT_EQ(product.items(), 12);
  EXPECT_THAT(product.value_indices(0), ElementsAre(0, 0, 0));
  EXPECT_THAT(product.value_indices(1), ElementsAre(0, 0, 1));
  EXPECT_THAT(product.value_indices(11), ElementsAre(2, 1, 1));
  const SweepSpec zip =
      parse_sweep_toml("combine = \"zip\"\ncodes = [\"a\", \"b\", \"c\"]\n" + axes);
  EXPECT_EQ(zip.items(), 6);
  EXPECT_THAT(zip.value_indices(1), ElementsAre(0, 1, 1));
  EXPECT_THAT(zip.value_indices(4), ElementsAre(2, 0, 0));
}

TEST(SweepSpec, KeysOfOneAxisVaryTogether) {
  const SweepSpec spec = parse_sweep_toml(head + R"(
[[axis]]
keys = ["light.impulse_response.f_max_hz", "sensor.impulse_response.f_max_hz"]
values = [1e8, [2e8, 15e7]]
[[axis]]
key = "seed"
values = [1, 2]
)");
  ASSERT_EQ(spec.axes.size(), 3);
  EXPECT_THAT(texts(spec.axes[0]), ElementsAre("100000000", "200000000"));
  EXPECT_THAT(texts(spec.axes[1]), ElementsAre("100000000", "150000000"));
  EXPECT_EQ(spec.items(), 4);
  EXPECT_THAT(spec.value_indices(1), ElementsAre(0, 0, 1));
  EXPECT_THAT(spec.value_indices(2), ElementsAre(1, 1, 0));
}

const std::string four_axes =
    "[[axis]]\nkey = \"samples\"\nvalues = [24, 30, 36]\ngroup = \"a\"\n"
    "[[axis]]\nkey = \"exposure_s\"\nvalues = [0.1, 0.2, 0.3]\ngroup = \"a\"\n"
    "[[axis]]\nkey = \"trials\"\nvalues = [10, 20]\ngroup = \"b\"\n"
    "[[axis]]\nkey = \"seed\"\nvalues = [1, 2, 3]\ngroup = \"b\"\n";

TEST(SweepSpec, GroupsAreCombinedInternallyFirst) {
  const std::string product_b = "[[group]]\nname = \"b\"\ncombine = \"product\"\n";
  const SweepSpec product = parse_sweep_toml(head + four_axes + product_b);
  EXPECT_EQ(product.items(), 3 * 6);
  EXPECT_THAT(product.value_indices(1), ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(product.value_indices(17), ElementsAre(2, 2, 1, 2));
  const SweepSpec zip =
      parse_sweep_toml("combine = \"zip\"\n" + head +
                       "[[axis]]\nkey = \"light.peak_factor\"\nvalues = [5, 6, 7, 8, 9, 10]\n" +
                       four_axes.substr(four_axes.find("[[axis]]\nkey = \"trials\"")) + product_b);
  EXPECT_EQ(zip.items(), 6);
  EXPECT_THAT(zip.value_indices(4), ElementsAre(4, 1, 1));
}

TEST(SweepSpec, WithoutAxesThereIsOneItem) { EXPECT_EQ(parse_sweep_toml(head).items(), 1); }

TEST(SweepSpec, TheNumberOfItemsSaturates) {
  std::string text = head;
  for (const char* key : {"seed", "samples", "light.peak_factor", "exposure_s", "trials",
                          "signal_e_per_s", "ambient_e_per_s"})
    text += std::string("[[axis]]\nkey = \"") + key + "\"\nfrom = 2\nto = 1001\nstep = 1\n";
  EXPECT_EQ(parse_sweep_toml(text).items(), std::int64_t{1} << 62);
}

TEST(SweepSpec, EveryKeyOfACameraCanVary) {
  const std::vector<std::string> keys = camera_keys();
  EXPECT_THAT(keys, testing::IsSupersetOf(
                        {"samples", "exposure_s", "light.peak_factor",
                         "light.impulse_response.f_max_hz", "sensor.generator.sample_rate_hz",
                         "lens.fx_px", "sensor.impulse_response.time_step_s", "operating.albedo"}));
  for (const std::string& key : keys)
    EXPECT_NO_THROW(with_axis("key = \"" + key + "\"\nvalues = [1]\n")) << key;
}

struct Refusal {
  std::string text;
  const char* message;
};

TEST(SweepSpec, RejectsUnknownInputWithItsPlace) {
  const auto axis = [](const std::string& lines) { return head + "[[axis]]\n" + lines; };
  for (const Refusal& refusal : {
           Refusal{"trials = 100\n", "s.toml: found no code; expected"},
           {head + "trails = 5\n", "s.toml:2:1: unknown key trails; did you mean trials?"},
           {head + "trials = 1\n",
            "s.toml:2:10: trials: found 1; expected an integer in [2, 4000000000]"},
           {head + "outlier_threshold_m = -1\n",
            "s.toml:2:23: outlier_threshold_m: found -1; expected a number >= 0"},
           {head + "method = \"zncc2\"\n", "s.toml:2:10: method: found \"zncc2\"; expected one of"},
           {head + "codes = [\"a\"]\n", "s.toml:1:8: code: is only valid with no codes"},
           {"codes = []\n", "s.toml:1:9: codes: found an empty list"},
           {axis("key = \"peak_factor\"\nvalues = [1]\n"),
            "s.toml:3:7: axis[0].key: found unknown axis \"peak_factor\"; did you mean "
            "\"light.peak_factor\"?"},
           {axis("key = \"sed\"\nvalues = [1]\n"), "did you mean \"seed\"?"},
           {axis("key = \"seed\"\nvalues = []\n"), "s.toml:4:10: axis[0].values: found an empty"},
           {axis("key = \"seed\"\n"), "s.toml:3:7: axis[0].key: found no values"},
           {axis("key = \"seed\"\nvalues = [1, -1]\n"), "s.toml:4:14: seed: found -1; expected"},
           {axis("key = \"seed\"\nvalues = [0.5]\n"), "s.toml:4:11: seed: found 0.5; expected"},
           {axis("key = \"trials\"\nvalues = [1]\n"),
            "s.toml:4:11: trials: found 1; expected an integer in [2, 4000000000]"},
           {axis("key = \"sub_bin\"\nvalues = [1]\n"),
            "s.toml:4:11: sub_bin: found 1; expected true or false"},
           {axis("key = \"method\"\nvalues = [\"magic\"]\n"),
            "s.toml:4:11: method: found \"magic\"; expected one of \"zncc\", "},
           {axis("key = \"code\"\nvalues = [\"a\"]\n"), "s.toml:3:7: found both an axis of codes"},
           {axis("key = \"seed\"\nfrom = 1\nto = 5\nstep = 0\n"), "s.toml:6:8: axis[0].step"},
           {axis("key = \"seed\"\nfrom = 1\nto = 5\nstep = -1\n"), "s.toml:6:8: axis[0].step"},
           {axis("key = \"seed\"\nfrom = 1\nto = 1e300\nstep = 1\n"), "found 1e+300 values"},
           {axis("key = \"seed\"\nfrom = 0\nto = 5\ncount = 3\n"), "s.toml:4:8: axis[0].from"},
           {axis("key = \"seed\"\nfrom = 1\nto = 5\ncount = 1\n"), "s.toml:6:9: axis[0].count"},
           {axis("key = \"seed\"\nfile = \"none.txt\"\n"), "s.toml:4:8: axis[0].file: none.txt"},
           {axis("key = \"seed\"\nvalues = [1]\n[[axis]]\nkey = \"seed\"\nvalues = [2]\n"),
            "s.toml:6:7: axis seed occurs twice; the first is at s.toml:3:7"},
           {"combine = \"zip\"\n" + axis("key = \"seed\"\nvalues = [1]\n[[axis]]\nkey = "
                                         "\"samples\"\nvalues = [24, 30]\n"),
            "s.toml:7:7: axis samples has 2 values and axis seed has 1"},
           {axis("key = \"exposures\"\nvalues = [3]\n"), "require each other"},
           {axis("keys = []\nvalues = [1]\n"), "s.toml:3:8: axis[0].keys: found an empty list"},
           {axis("keys = [\"seed\"]\nkey = \"seed\"\nvalues = [1]\n"),
            "s.toml:4:7: axis[0].key: is only valid with no keys"},
           {axis("keys = [\"seed\", \"sampels\"]\nvalues = [1]\n"),
            "axis[0].keys: found unknown axis \"sampels\"; did you mean \"samples\"?"},
           {axis("keys = [\"seed\", \"seed\"]\nvalues = [1]\n"), "axis seed occurs twice"},
           {axis("keys = [\"seed\", \"samples\"]\nvalues = [1, [1, 2, 3]]\n"),
            "s.toml:4:14: found [1, 2, 3]; expected one value for all of seed, samples, or a list "
            "of 2, one for each"},
           {axis("keys = [\"seed\", \"samples\"]\nvalues = [[1, 24]]\n[[axis]]\nkey = "
                 "\"samples\"\nvalues = [24]\n"),
            "axis samples occurs twice; the first is at s.toml:3:8"},
           {head + four_axes.substr(0, four_axes.find("[[axis]]\nkey = \"seed\"")) +
                "[[axis]]\nkey = \"seed\"\nvalues = [1]\ngroup = \"a\"\n",
            "axis seed has 1 values and samples has 3; expected equal numbers in a zipped group"},
           {"combine = \"zip\"\n" + head + four_axes +
                "[[group]]\nname = \"b\"\ncombine = \"product\"\n",
            "group b has 6 values and group a has 3; expected equal numbers with combine = "
            "\"zip\""},
           {head + four_axes + "[[group]]\nname = \"aa\"\ncombine = \"zip\"\n",
            "group[0].name: found \"aa\", a group without axes"},
           {head + four_axes + "[[group]]\nname = \"a\"\n", "combine"},
           {"code = \"hamiltonian-k{exposures}\"\n", "require each other"},
       }) {
    SCOPED_TRACE(refusal.text);
    EXPECT_THAT([&] { parse_sweep_toml(refusal.text, "s.toml"); },
                ThrowsMessage<IoError>(HasSubstr(refusal.message)));
  }
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/text/field_toml.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

// Outside the unnamed namespace, like described structs: describe() is found by its argument.
struct Fan {
  int blades = 5;
  friend bool operator==(const Fan&, const Fan&) = default;
};
inline void describe(FieldVisitor& fields, Fan& fan) {
  fields.value(Key("blades", "Number of blades", closed(2, 9)), fan.blades);
}

enum class Cooling { passive, forced };
constexpr auto words_of(Cooling /*any*/) { return word_list("passive", "forced"); }

struct Housing {
  double depth_m = 0.1;
  std::optional<double> mass_kg;
  std::vector<double> slots_m = {0.01, 0.02};
  double gain = 1.0;
  std::vector<double> gains;
  double share = 1.0;
  bool any_share = false;
  std::vector<double> marks;
  Cooling cooling = Cooling::passive;
  double speed_hz = 0.0;
  std::optional<Fan> fan;
  std::optional<Fan> spare;
  friend bool operator==(const Housing&, const Housing&) = default;
};
inline void describe(FieldVisitor& fields, Housing& housing) {
  fields.value(Key("depth_m", "Depth", above(0)).required("0.2"), housing.depth_m);
  fields.value(Key("mass_kg", "Mass", above(0)).because("it is there"), housing.mass_kg);
  fields.value(Key("slots_m", "Widths of the slots", at_least(0)), housing.slots_m);
  fields.value(Key("gain", "Gain", above(0)), NumberOrList{housing.gain, housing.gains});
  fields.value(Key("share", "Share", left_open(0, 1)),
               NumberOrWord{housing.share, "any", housing.any_share});
  fields.value(Key("marks", "Marks"), RawNumberList{housing.marks});
  fields.choice(Key("cooling", "Kind of cooling"), housing.cooling);
  fields.value(Key("speed_hz", "Speed of the fan", above(0))
                   .required("50.0")
                   .only(housing.cooling == Cooling::forced, "cooling = \"forced\""),
               housing.speed_hz);
  fields.table(Key("fan", "The fan"), housing.fan);
  fields.part(Key("spare", "Spare fan"), housing.spare);
}

namespace {

Housing parse(std::string_view text) {
  const Document document = parse_toml(text, "h.toml");
  TableReader table(document);
  Housing housing;
  FieldReader reader(table);
  describe(reader, housing);
  table.finish();
  return housing;
}

std::string problem_of(const std::string& text) {
  try {
    parse(text);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(DescribedStruct, IsReadFromToml) {
  const Housing housing = parse(
      "depth_m = 0.3\nmass_kg = 2\ngain = [1, 2.5]\nshare = \"any\"\nmarks = [0, \"nan\"]\n"
      "cooling = \"forced\"\nspeed_hz = 30.0\nblades = 4\n[fan]\nblades = 7\n");
  EXPECT_EQ(housing.depth_m, 0.3);
  EXPECT_EQ(housing.mass_kg, 2.0);
  EXPECT_THAT(housing.slots_m, testing::ElementsAre(0.01, 0.02)) << "stays";
  EXPECT_THAT(housing.gains, testing::ElementsAre(1.0, 2.5));
  EXPECT_TRUE(housing.any_share);
  EXPECT_TRUE(std::isnan(housing.marks.at(1)));
  EXPECT_EQ(housing.cooling, Cooling::forced);
  EXPECT_EQ(housing.speed_hz, 30.0);
  EXPECT_EQ(housing.fan, Fan{7});
  EXPECT_EQ(housing.spare, Fan{4}) << "a part has its keys in the outer table";
  EXPECT_EQ(parse("depth_m = 0.3\n").spare, std::nullopt);
}

TEST(DescribedStruct, ReadingUndoesWriting) {
  const Housing housing{.depth_m = 0.3,
                        .gains = {1.0, 2.0},
                        .cooling = Cooling::forced,
                        .speed_hz = 10.0,
                        .fan = Fan{3}};
  const nlohmann::ordered_json document = described_json(housing);
  EXPECT_EQ(document.dump(), R"({"depth_m":0.3,"slots_m":[0.01,0.02],"gain":[1.0,2.0],"share":1.0,)"
                             R"("cooling":"forced","speed_hz":10.0,"fan":{"blades":3}})");
  EXPECT_EQ(parse("depth_m = 0.3\nslots_m = [0.01, 0.02]\ngain = [1.0, 2.0]\nshare = 1.0\n"
                  "cooling = \"forced\"\nspeed_hz = 10.0\nfan = { blades = 3 }\n"),
            housing);
}

TEST(DescribedStruct, RejectsValuesOutsideItsDescription) {
  EXPECT_EQ(problem_of("mass_kg = 1"),
            "h.toml: found no depth_m; expected a line such as `depth_m = 0.2`");
  EXPECT_EQ(problem_of("depth_m = \"deep\""),
            "h.toml:1:11: depth_m: found \"deep\"; expected a number");
  EXPECT_EQ(problem_of("depth_m = 1\nspeed_hz = 3"),
            "h.toml:2:12: speed_hz: is only valid with cooling = \"forced\"");
  EXPECT_EQ(problem_of("depth_m = 1\ncooling = \"frced\""),
            "h.toml:2:11: cooling: found \"frced\"; expected one of \"passive\", \"forced\"; did "
            "you mean \"forced\"?");
  EXPECT_EQ(problem_of("depth_m = 1\nbladse = 3"),
            "h.toml:2:1: unknown key bladse; did you mean blades?");
  EXPECT_EQ(problem_of("depth_m = 1\nfan.blade = 3"),
            "h.toml:2:5: unknown key fan.blade; did you mean fan.blades?");
}

TEST(DescribedStruct, IsCheckedForItsRanges) {
  const auto broken = [](const Housing& housing) -> std::string {
    try {
      check_ranges(housing, "housing.");
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(broken({}), "");
  EXPECT_EQ(broken({.mass_kg = 0.0}), "housing.mass_kg = 0; must be finite and > 0: it is there");
  EXPECT_EQ(broken({.slots_m = {1.0, -2.0}}), "housing.slots_m[1] = -2; must be finite and >= 0");
  EXPECT_EQ(broken({.gains = {0.0}}), "housing.gain[0] = 0; must be finite and > 0");
  EXPECT_EQ(broken({.share = 2.0}), "housing.share = 2; must be in (0, 1]");
  EXPECT_EQ(broken({.fan = Fan{1}}), "housing.fan.blades = 1; must be in [2, 9]");
  EXPECT_EQ(broken({.spare = Fan{10}}), "housing.blades = 10; must be in [2, 9]");
  EXPECT_EQ(broken({.speed_hz = -1.0}), "") << "a key that does not apply";
}

TEST(DescribedStruct, ListsItsKeys) {
  KeyList list;
  Housing housing;
  describe(list, housing);
  std::vector<std::string> names;
  for (const KeyDescription& key : list.keys) names.push_back(key.name);
  EXPECT_THAT(names, testing::ElementsAre("depth_m", "mass_kg", "slots_m", "gain", "share", "marks",
                                          "cooling", "speed_hz", "fan", "fan.blades", "blades"));
  const KeyDescription& mass = list.keys.at(1);
  EXPECT_TRUE(mass.may_be_absent);
  EXPECT_EQ(mass.type, ValueType::number);
  EXPECT_EQ(mass.key.help, "Mass");
  const KeyDescription& speed = list.keys.at(7);
  EXPECT_FALSE(speed.key.applies);
  EXPECT_EQ(speed.type, ValueType::number);
  EXPECT_EQ(unit_of_key(speed.name), "Hz");
  EXPECT_THAT(list.keys.at(6).words, testing::ElementsAre("passive", "forced"));
  EXPECT_EQ(list.keys.at(10).part, "spare");
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "described_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "field_list.hpp"
#include "io/text/field_json.hpp"
#include "io/text/shared/field_key.hpp"

namespace tofsmith {

// Outside the unnamed namespace, like options: fields_of() is found by its argument.
enum class Heat { top, bottom, both };
constexpr auto words_of(Heat /*any*/) { return word_list("top", "bottom", "both"); }

struct Course {
  int number = 1, count = 1;

  static constexpr char separator = '/';
  static constexpr std::string_view rule = "number <= count";
  static constexpr std::string_view example = "1/3";
  bool is_valid() const { return number <= count; }
};
auto fields_of(ConstOrNot<Course> auto& c) {
  return std::tuple(Field("number", c.number), Field("count", c.count));
}

struct Oven {
  int trays = 4;
  double power_w = 900.0;
  std::optional<double> door_m;
  bool fan = true;
  bool grill = false;
  Heat heat = Heat::both;
  std::optional<Heat> night;
  std::vector<double> time_s = {60.0};
  std::string recipe;
  Course course;
};
auto fields_of(ConstOrNot<Oven> auto& o) {
  return std::tuple(Field("trays", o.trays, closed(1, 9), Help{"number of trays"}, ByEffort{2}),
                    Field("power_w", o.power_w, above(0), Help{"power"}),
                    Field("door_m", o.door_m, above(0), Help{"width of the door"},
                          IfAbsent{"as wide as the oven"}),
                    Field("fan", o.fan, Help{"circulate the air"}),
                    Field("grill", o.grill, Help{"brown the top"}, OnlyWith{"heat top"}),
                    Field("heat", o.heat, Help{"where heat comes from"}),
                    Field("night", o.night, Help{"heat at night"}, IfAbsent{"none"}),
                    Field("time_s", o.time_s, at_least(0), Help{"times"}),
                    Field("recipe", o.recipe, Help{"name of the recipe"}, OnlyWith{"grill"}),
                    Field("course", o.course, Help{"course of the meal"}));
}

namespace apps {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A command with an option for each field, "--door-m", but "--no-fan".
class OvenCommand {
 public:
  OvenCommand() {
    const FieldOptions options(app_, oven);
    options.add("trays");
    options.add("fan", "!--no-fan");
    options.add_others({"fan"});
  }

  std::string parse(std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);
    try {
      app_.parse(arguments);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "";
  }
  std::string help() const { return app_.help(); }

  Oven oven;

 private:
  CLI::App app_;
};

TEST(DescribedOptions, AreParsedIntoTheirFields) {
  OvenCommand command;
  EXPECT_EQ(command.parse({"--trays", "7", "--power-w=800", "--door-m", "0.4", "--no-fan",
                           "--grill", "--heat", "top", "--night", "bottom", "--time-s", "1,2.5",
                           "--recipe", "bread", "--course", "2/3"}),
            "");
  EXPECT_EQ(command.oven.trays, 7);
  EXPECT_EQ(command.oven.power_w, 800.0);
  EXPECT_EQ(command.oven.door_m, 0.4);
  EXPECT_FALSE(command.oven.fan);
  EXPECT_TRUE(command.oven.grill);
  EXPECT_EQ(command.oven.heat, Heat::top);
  EXPECT_EQ(command.oven.night, Heat::bottom);
  EXPECT_THAT(command.oven.time_s, ElementsAre(1.0, 2.5));
  EXPECT_EQ(command.oven.recipe, "bread");
  EXPECT_EQ(command.oven.course.number, 2);
  EXPECT_EQ(command.oven.course.count, 3);
}

TEST(DescribedOptions, KeepDefaultsUnlessGiven) {
  OvenCommand command;
  EXPECT_EQ(command.parse({}), "");
  EXPECT_EQ(fields_json(command.oven), fields_json(Oven{}));
}

TEST(DescribedOptions, RejectValuesOutsideTheirDescription) {
  const auto refused = [](std::vector<std::string> arguments) {
    return OvenCommand().parse(std::move(arguments));
  };
  EXPECT_EQ(refused({"--trays", "10"}), "--trays: found 10; must be in [1, 9]");
  EXPECT_EQ(refused({"--power-w", "nan"}), "--power-w: found nan; must be finite and > 0");
  EXPECT_EQ(refused({"--door-m", "-1"}), "--door-m: found -1; must be finite and > 0");
  EXPECT_EQ(refused({"--time-s", "1,-2"}), "--time-s: found -2; must be finite and >= 0");
  EXPECT_THAT(refused({"--heat", "botom"}), HasSubstr("did you mean bottom?"));
  EXPECT_THAT(refused({"--night", "warm"}), HasSubstr("top,bottom,both"));
  EXPECT_EQ(refused({"--recipe", "bread"}), "--recipe requires --grill");
  for (const char* course : {"2", "2/x", "3/2"})
    EXPECT_EQ(refused({"--course", course}),
              "--course: found " + std::string(course) + "; expected number <= count, such as 1/3");
}

TEST(DescribedOptions, ShowDescriptionAndDefaultInHelp) {
  const std::string help = OvenCommand().help();
  EXPECT_THAT(help, ContainsRegex("--trays INT:in .1, 9.( .4.|=4)"));
  EXPECT_THAT(help, HasSubstr("number of trays"));
  EXPECT_THAT(help, HasSubstr("power [W]"));
  EXPECT_THAT(help, HasSubstr("width of the door [m] (default: as wide as the oven)"));
  EXPECT_THAT(help, HasSubstr("do not circulate the air"));
  EXPECT_THAT(help, HasSubstr("brown the top; only with heat top"));
  EXPECT_THAT(help, ContainsRegex("--heat TEXT:.top,bottom,both.( .both.|=both)"));
  EXPECT_THAT(help, HasSubstr("heat at night (default: none)"));
  EXPECT_THAT(help, HasSubstr("times [s]"));
  EXPECT_THAT(help, HasSubstr("course of the meal; example: 1/3"));
  EXPECT_THAT(help, Not(HasSubstr("only with grill")));
}

TEST(DescribedOptions, AreInDocumentsKeysAndDescriptionsForOtherLanguages) {
  const nlohmann::ordered_json document = fields_json(Oven{.night = Heat::top, .time_s = {}});
  std::string key;
  append_key(key, Oven());
  const nlohmann::ordered_json list = fields_list<Oven>();
  std::size_t listed = 0;
  const Oven oven;
  for_each_field(oven, [&](const auto& field) {
    EXPECT_TRUE(document.contains(field.name) || field.name == std::string("door_m"));
    EXPECT_THAT(key, HasSubstr(std::string(field.name) + "="));
    EXPECT_EQ(list.at(listed++).at("name"), field.name);
  });
  EXPECT_EQ(list.size(), listed);
  EXPECT_EQ(list.at(0).at("range"), "in [1, 9]");
  EXPECT_EQ(list.at(1).at("unit"), "W");
  EXPECT_EQ(list.at(2).at("default"), nullptr);
  EXPECT_EQ(list.at(2).at("if_absent"), "as wide as the oven");
  EXPECT_EQ(list.at(4).at("only_with"), "heat top");
  EXPECT_EQ(list.at(5).at("default"), "both");
  EXPECT_THAT(list.at(6).at("words"), ElementsAre("top", "bottom", "both"));
  EXPECT_EQ(list.at(7).at("type"), "number[]");
  EXPECT_EQ(list.at(9).at("type"), "integer[2]");
}

}  // namespace
}  // namespace apps
}  // namespace tofsmith

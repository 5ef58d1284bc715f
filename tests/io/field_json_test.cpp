// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/field_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "damaged_files.hpp"
#include "io/documents/shared/document_text.hpp"
#include "io/text/shared/field_key.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

struct Step {
  double work = 0.0, error_m = 0.0;
};
auto fields_of(ConstOrNot<Step> auto& s) {
  return std::tuple(Field("work", s.work), Field("error_m", s.error_m));
}

struct Finding {
  std::string name;
  int starts = 4;
  Estimate error_m;
  std::vector<Step> steps;
  std::optional<OperatingPoint> point;
  double bound_m = 0.0;
};
auto fields_of(ConstOrNot<Finding> auto& f) {
  return std::tuple(Field("name", f.name), Field("starts", f.starts, at_least(1), ByEffort{1}),
                    Field("error_m", f.error_m, at_least(0)), Field("steps", f.steps),
                    Field("point", f.point),
                    Field("bound_m", f.bound_m, at_least(0).or_infinity()));
}

/// A Finding with one added field, and no other change than its description.
struct Grown {
  int starts = 4;
  int added = 8;
};
auto fields_of(ConstOrNot<Grown> auto& g) {
  return std::tuple(Field("starts", g.starts, at_least(1)),
                    Field("added", g.added, closed(3, 16), ByEffort{3}));
}

namespace {

using testing::HasSubstr;

template <typename Struct>
Struct read_back(const nlohmann::ordered_json& json) {
  const Document document = parse_json(json.dump(), "a.json");
  return fields_from_json<Struct>(ValueReader(document));
}

template <typename Struct>
std::string key_of(const Struct& its) {
  std::string key;
  append_key(key, its);
  return key;
}

Finding finding() {
  return {.name = "a",
          .starts = 7,
          .error_m = {1.5, 0.25},
          .steps = {{1.0, 0.5}, {2.0, 0.25}},
          .point = OperatingPoint{1e4, 2e4},
          .bound_m = std::numeric_limits<double>::infinity()};
}

TEST(FieldJson, IsAnObjectOfTheFields) {
  EXPECT_EQ(fields_json(finding()).dump(),
            R"({"name":"a","starts":7,"error_m":1.5,"error_se_m":0.25,"steps":[[1.0,0.5],)"
            R"([2.0,0.25]],"point":{"signal_e_per_s":10000.0,"ambient_e_per_s":20000.0},)"
            R"("bound_m":null})");
}

TEST(FieldJson, ReadingUndoesWriting) {
  for (const Finding& written : {finding(), Finding{}})
    EXPECT_EQ(fields_json(read_back<Finding>(fields_json(written))), fields_json(written));
}

TEST(FieldJson, RejectsMissingMembersAndInvalidValues) {
  const auto refusal = [](const char* name, const nlohmann::ordered_json& value) {
    nlohmann::ordered_json json = fields_json(finding());
    if (value.is_discarded())
      json.erase(name);
    else
      json[name] = value;
    return io_error_of([&] { read_back<Finding>(json); });
  };
  const nlohmann::ordered_json missing(nlohmann::ordered_json::value_t::discarded);
  const Finding whole = finding();
  for_each_field(whole, [&](const auto& field) {
    EXPECT_THAT(refusal(field.name, missing), HasSubstr(field.name));
  });
  EXPECT_EQ(refusal("starts", 0), "a.json: /starts: found 0; expected an integer >= 1");
  EXPECT_EQ(refusal("error_m", -1),
            "a.json: /error_m: found -1; expected a number finite and >= 0");
  EXPECT_EQ(refusal("steps", nlohmann::ordered_json::array({{1.0}})),
            "a.json: /steps/0: found a list of 1; expected a list of 2: work, error_m");
}

TEST(Fields, AnAddedFieldIsSupportedEverywhere) {
  EXPECT_THROW(check_fields(Grown{.added = 2}), std::invalid_argument);
  EXPECT_NE(key_of(Grown{}), key_of(Grown{.added = 9}));
  EXPECT_EQ(fields_json(Grown{.added = 9})["added"], 9);
  EXPECT_EQ(read_back<Grown>(fields_json(Grown{.added = 9})).added, 9);
  Grown scaled;
  scale_by_effort(scaled, 0.5);
  EXPECT_EQ(scaled.added, 4);
  EXPECT_EQ(scaled.starts, 4) << "not marked";
}

/// Changes every field in turn, also of members, and calls `visit` with the changed struct.
template <typename Struct, typename Visit>
void for_each_change(Struct& its, const Visit& visit, const std::string& owner = "") {
  for_each_field(its, [&](const auto& field) {
    auto& value = field.value;
    using Value = std::remove_reference_t<decltype(value)>;
    const std::string name = owner + field.name;
    const Value before = value;
    if constexpr (HasFields<Value>)
      for_each_change(value, visit, name + ".");
    else if constexpr (is_optional<Value>)
      value.emplace();
    else if constexpr (is_list<Value>)
      value.emplace_back();
    else if constexpr (std::is_enum_v<Value>)
      value = static_cast<Value>(value == Value{} ? 1 : 0);
    else if constexpr (std::is_same_v<Value, bool>)
      value = !value;
    else
      value += 1;
    visit(name);
    value = before;
  });
}

TEST(FieldKey, DiffersIfAnyFieldOfDesignOptionsDiffers) {
  DesignOptions options;
  const std::string key = key_of(options);
  int changed = 0;
  for_each_change(options, [&](const std::string& name) {
    if (name == "factorize" || name == "optimize" || name == "search") return;
    // Fields that DesignOptions overrides do not count.
    const bool is_set_from_above = name == "factorize.seed" || name == "optimize.seed" ||
                                   name == "search.seed" || name == "search.exposures";
    EXPECT_EQ(key_of(options) == key, is_set_from_above) << name;
    ++changed;
  });
  EXPECT_GT(changed, 40);
  EXPECT_EQ(key_of(options), key);
}

TEST(FieldKey, DistinguishesLists) {
  DesignOptions a, b;
  a.baselines = {"x", "y"};
  b.baselines = {"x,y"};
  EXPECT_NE(key_of(a), key_of(b));
  EXPECT_NE(key_of(std::optional<std::vector<int>>()),
            key_of(std::make_optional<std::vector<int>>()));
}

using testing::StartsWith;

std::string refusal(std::string_view text) {
  return io_error_of([&] { parse_json(text, "a.json"); });
}

TEST(JsonText, ErrorsNameLineAndColumn) {
  EXPECT_THAT(refusal("{\n  \"a\": 1,\n  \"b\": x\n}"), StartsWith("a.json:3:8: "));
  EXPECT_THAT(refusal("[1 2]"), StartsWith("a.json:1:4: "));
  EXPECT_THAT(refusal(""), StartsWith("a.json:1:1: "));
  EXPECT_THAT(refusal("[1,\n"), StartsWith("a.json:2:1: "));
  EXPECT_THAT(refusal("[1] 2"), StartsWith("a.json:1:5: "));
  EXPECT_THAT(refusal(std::string(10'000'000, '[')), HasSubstr("more than 64 deep"));
  EXPECT_THAT(refusal("\"\xff\""), StartsWith("a.json:1:"));
  EXPECT_THAT(refusal("[1e999]"), StartsWith("a.json"));
  EXPECT_THAT(refusal(std::string_view("[1]\n\0 2", 7)),
              StartsWith("a.json:2:1: found a zero byte"));
}

TEST(JsonText, ErrorsQuoteTheUnexpectedText) {
  EXPECT_THAT(refusal("[1 2]"), HasSubstr("unexpected number literal"));
  EXPECT_THAT(refusal("[1 2]"), testing::Not(HasSubstr("json.exception")));
}

}  // namespace

}  // namespace tofsmith

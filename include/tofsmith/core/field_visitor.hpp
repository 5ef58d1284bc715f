// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "tofsmith/core/range.hpp"
#include "tofsmith/core/units.hpp"

// The description of a struct that users set by keys, such as the tables of a camera file. Each
// such struct has one function, next to its declaration, that passes its members to a visitor:
//
//   inline void describe(FieldVisitor& fields, Generator& generator) {
//     fields.value(Key("amplitude_bits", "Resolution of the amplitude", closed(1, 24)),
//                  generator.amplitude_bits);
//   }
//
// Visitors read and write documents, check ranges and list keys. Nothing else contains the name,
// the range or the help text of a key. Units follow from the end of the name: unit_of_key().
namespace tofsmith {

/// What a description states about a key besides its value.
struct Key {
  std::string_view name;
  std::string_view help;            ///< noun phrase without unit, range and default
  Range range = {};                 ///< of a number, or of each number of a list
  std::string_view reason = {};     ///< why numbers outside the range are rejected
  std::string_view example = {};    ///< of a required key; empty: the key is optional
  std::string_view condition = {};  ///< of a key that does not always apply, as a user writes it
  bool applies = true;              ///< whether the condition holds for this struct
  bool is_basic = false;            ///< one of the keys that most users change
  double usual_low = 0.0, usual_high = 0.0;  ///< numbers that most cameras have; both 0: unknown

  Key(std::string_view its_name, std::string_view its_help, Range its_range = {})
      : name(its_name), help(its_help), range(its_range) {}

  Key& because(std::string_view why) { return reason = why, *this; }
  Key& required(std::string_view its_example) { return example = its_example, *this; }
  Key& only(bool holds, std::string_view its_condition) {
    return applies = holds, condition = its_condition, *this;
  }
  Key& basic() { return is_basic = true, *this; }
  Key& usually(double low, double high) { return usual_low = low, usual_high = high, basic(); }
};

/// One word of several.
struct WordChoice {
  std::span<const std::string_view> words;
  std::size_t chosen;
};
/// A number, or a list with at least one number; the list is empty if there is a single number.
struct NumberOrList {
  double& number;
  std::vector<double>& list;
};
/// A number, or a word in its place.
struct NumberOrWord {
  double& number;
  std::string_view word;
  bool& is_word;
};
/// A list of raw numbers, which may be NaN or infinite. Empty if the key is not given.
struct RawNumberList {
  std::vector<double>& numbers;
};
/// The path of a file to read; relative paths start where the document is. Empty if the key is not
/// given.
struct InputPath {
  std::string& path;
};

/// Visits the keys of described structs in the order of their description. A visitor may change the
/// values, so that later keys can depend on earlier ones.
class FieldVisitor {
 public:
  using Value = std::variant<bool*, int*, double*, std::string*, std::vector<double>*,
                             std::vector<int>*, std::array<double, 2>*, WordChoice*, NumberOrList,
                             NumberOrWord, RawNumberList, InputPath>;

  virtual ~FieldVisitor() = default;

  template <typename Type>
  void value(const Key& key, Type&& target) {
    if constexpr (std::is_constructible_v<Value, std::remove_cvref_t<Type>*>)
      pass(key, &target);
    else
      pass(key, std::forward<Type>(target));
  }
  template <typename Type>
  void value(const Key& key, std::optional<Type>& target) {
    if (key.applies && !wants(key, target.has_value())) return;
    Type blank{};
    if (key.applies && !target) target.emplace();
    pass(key, target ? &*target : &blank);
  }
  /// One of `words`, the enumerators in their order.
  template <typename Enum>
  void choice(const Key& key, Enum& target, std::span<const std::string_view> words) {
    WordChoice choice{words, static_cast<std::size_t>(target)};
    pass(key, &choice);
    target = static_cast<Enum>(choice.chosen);
  }
  /// A table with the keys of a struct.
  /// @param visit_fields  calls value() for each key: (FieldVisitor&, Struct&); describe()
  /// otherwise
  template <typename Struct, typename Describe>
  void table(const Key& key, Struct& target, const Describe& visit_fields) {
    if (!enter(key)) return;
    visit_fields(*this, target);
    leave();
  }
  template <typename Struct>
  void table(const Key& key, Struct& target) {
    table(key, target, [](FieldVisitor& fields, Struct& its) { describe(fields, its); });
  }
  template <typename Struct>
  void table(const Key& key, std::optional<Struct>& target) {
    if (!wants(key, target.has_value())) return;
    if (!target) target.emplace();
    table(key, *target);
  }
  /// A struct whose keys stand in the table of the struct that contains it.
  /// @param key           names the part in lists; documents do not contain it
  /// @param visit_fields  calls value() for each key: (FieldVisitor&, Struct&)
  template <typename Struct, typename Describe>
  void part(const Key& key, std::optional<Struct>& target, const Describe& visit_fields) {
    Struct blank{};
    const auto names = names_of([&](FieldVisitor& inner) { visit_fields(inner, blank); });
    if (!enter_part(key, names, target.has_value())) return;
    if (!target) target.emplace();
    visit_fields(*this, *target);
    leave_part();
  }
  template <typename Struct>
  void part(const Key& key, std::optional<Struct>& target) {
    part(key, target, [](FieldVisitor& fields, Struct& its) { describe(fields, its); });
  }

 protected:
  virtual void visit(const Key& key, const Value& value) = 0;
  /// Whether to visit a key, and thereby to create its value, that may be absent.
  virtual bool wants(const Key& key, bool is_there) = 0;
  /// Called instead of visit() for a key that does not apply.
  virtual void refuse(const Key& key, const Value& value) = 0;
  /// Whether to visit the keys of a table. leave() follows the last of them.
  virtual bool enter(const Key& key) = 0;
  virtual void leave() = 0;
  /// Whether to visit the keys of a part, `names`, and thereby to create its struct, which may be
  /// absent. leave_part() follows the last of them.
  virtual bool enter_part(const Key& key, std::span<const std::string> names, bool is_there) = 0;
  virtual void leave_part() {}

 private:
  void pass(const Key& key, const Value& value) {
    key.applies ? visit(key, value) : refuse(key, value);
  }
  template <typename Describe>
  static std::vector<std::string> names_of(const Describe& describe_struct);
};

/// Collects the names of the keys of one struct, also of keys that do not apply.
class KeyNames : public FieldVisitor {
 public:
  std::vector<std::string> names;

 protected:
  void visit(const Key& key, const Value& /*value*/) override { names.emplace_back(key.name); }
  bool wants(const Key& /*key*/, bool /*is_there*/) override { return true; }
  void refuse(const Key& key, const Value& /*value*/) override { names.emplace_back(key.name); }
  bool enter(const Key& key) override { return names.emplace_back(key.name), false; }
  void leave() override {}
  bool enter_part(const Key&, std::span<const std::string>, bool) override { return true; }
};

template <typename Describe>
std::vector<std::string> FieldVisitor::names_of(const Describe& describe_struct) {
  KeyNames collector;
  describe_struct(collector);
  return std::move(collector.names);
}

/// Type of the value of a key.
enum class ValueType {
  boolean,
  integer,
  number,
  text,
  numbers,
  integers,
  number_pair,
  choice,
  number_or_list,
  number_or_word,
  raw_numbers,
  path,
  table,
};
/// The enumerator's name.
std::string_view name_of(ValueType type);

/// A key with the tables that contain it, and its description.
struct KeyDescription {
  std::string name;  ///< such as "light.impulse_response.f_max_hz"
  std::string part;  ///< part of the table that the key belongs to, if the table has parts
  ValueType type = ValueType::number;
  std::vector<std::string> words = {};  ///< of a choice, or instead of a number
  bool may_be_absent = false;           ///< without a default
  Key key;                              ///< range, help and condition
};

/// Lists the keys of described structs, also keys that do not apply and keys of absent tables.
class KeyList : public FieldVisitor {
 public:
  std::vector<KeyDescription> keys;

 protected:
  void visit(const Key& key, const Value& value) override;
  bool wants(const Key& key, bool is_there) override;
  void refuse(const Key& key, const Value& value) override { visit(key, value); }
  bool enter(const Key& key) override;
  void leave() override { prefixes_.pop_back(); }
  bool enter_part(const Key& key, std::span<const std::string> names, bool is_there) override;
  void leave_part() override { parts_.pop_back(); }

 private:
  KeyDescription& add(const Key& key, ValueType type);

  std::vector<std::string> prefixes_{""};
  std::vector<std::string> parts_{""};
  bool is_optional_ = false;  ///< the next key
};

/// Checks the range of every number.
class RangeCheck : public FieldVisitor {
 public:
  /// @param prefix  before the names of keys in errors: "light."
  explicit RangeCheck(std::string prefix = "") : prefixes_{std::move(prefix)} {}

 protected:
  /// @throws InvalidArgument "light.peak_factor = 0; must be finite and >= 1"
  void visit(const Key& key, const Value& value) override;
  bool wants(const Key& /*key*/, bool is_there) override { return is_there; }
  void refuse(const Key& /*key*/, const Value& /*value*/) override {}
  bool enter(const Key& key) override {
    prefixes_.push_back(prefixes_.back() + std::string(key.name) + ".");
    return true;
  }
  void leave() override { prefixes_.pop_back(); }
  bool enter_part(const Key&, std::span<const std::string>, bool is_there) override {
    return is_there;
  }

 private:
  std::vector<std::string> prefixes_;
};

/// Checks the range of every number of a described struct.
/// @param prefix  before the names of keys in errors: "light."
/// @throws InvalidArgument "light.peak_factor = 0; must be finite and >= 1"
template <typename Struct>
void check_ranges(Struct its, std::string prefix = "") {
  RangeCheck check(std::move(prefix));
  describe(check, its);
}

}  // namespace tofsmith

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
#include "tofsmith/core/words.hpp"

namespace tofsmith {

// Structs that users set by keys, such as the tables of a camera file, have a function that passes
// their members to a visitor:
//
//   inline void describe(FieldVisitor& fields, Generator& generator) {
//     fields.value(Key("amplitude_bits", "Resolution of the amplitude", closed(1, 24)),
//                  generator.amplitude_bits);
//   }
//
// Visitors read and write documents, check ranges and list keys. Names, ranges and help texts are
// defined only there. Units follow from the end of the name: unit_of_key().

/// Name, range and help text of a key.
struct Key {
  std::string_view name;
  std::string_view help;                     ///< noun phrase without unit, range and default
  Range range = {};                          ///< of a number, or of each number in a list
  std::string_view reason = {};              ///< why other numbers are rejected
  std::string_view example = {};             ///< for a required key; empty: optional
  std::string_view condition = {};           ///< if the key does not always apply
  bool applies = true;                       ///< the condition holds
  bool is_basic = false;                     ///< commonly changed
  double usual_low = 0.0, usual_high = 0.0;  ///< range of typical cameras; both 0: unknown

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

struct WordChoice {
  std::span<const std::string_view> words;
  std::size_t chosen;
};
/// The list is empty if there is a single number.
struct NumberOrList {
  double& number;
  std::vector<double>& list;
};
struct NumberOrWord {
  double& number;
  std::string_view word;
  bool& is_word;
};
/// Numbers may be NaN or infinite. Empty if the key is absent.
struct RawNumberList {
  std::vector<double>& numbers;
};
/// Relative to the document. Empty if the key is absent.
struct InputPath {
  std::string& path;
};

/// Visits the keys of described structs in order. Later keys may depend on values that a visitor
/// changed.
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
  template <HasWords Enum>
  void choice(const Key& key, Enum& target) {
    WordChoice choice{all_words<Enum>, static_cast<std::size_t>(target)};
    pass(key, &choice);
    target = static_cast<Enum>(choice.chosen);
  }
  /// A table with the keys of a struct.
  /// @param visit_fields  calls value() for each key; default: describe()
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
  /// A struct whose keys are in the table of the containing struct.
  /// @param key  name of the part in lists; not in documents
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
  /// Returns true to visit a key that may be absent, which creates its value.
  virtual bool wants(const Key& key, bool is_there) = 0;
  /// Called instead of visit() for a key that does not apply.
  virtual void refuse(const Key& key, const Value& value) = 0;
  /// Returns true to visit the keys of a table, followed by leave().
  virtual bool enter(const Key& key) = 0;
  virtual void leave() = 0;
  /// Returns true to visit the keys of a part, which creates its struct if absent; followed by
  /// leave_part().
  virtual bool enter_part(const Key& key, std::span<const std::string> names, bool is_there) = 0;
  virtual void leave_part() {}

 private:
  void pass(const Key& key, const Value& value) {
    key.applies ? visit(key, value) : refuse(key, value);
  }
  template <typename Describe>
  static std::vector<std::string> names_of(const Describe& describe_struct);
};

/// Collects the names of all keys, including keys that do not apply.
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
constexpr auto words_of(ValueType /*any*/) {
  return word_list("boolean", "integer", "number", "text", "numbers", "integers", "number_pair",
                   "choice", "number_or_list", "number_or_word", "raw_numbers", "path", "table");
}

struct KeyDescription {
  std::string name;  ///< with tables: "light.impulse_response.f_max_hz"
  std::string part;  ///< part of the table, if any
  ValueType type = ValueType::number;
  std::vector<std::string> words = {};  ///< of a choice, or instead of a number
  bool may_be_absent = false;           ///< no default
  Key key;                              ///< range, help and condition
};

/// Lists all keys, including keys that do not apply and keys of absent tables.
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
  bool is_optional_ = false;  ///< for the next key
};

/// Visits the keys that are present and apply.
class PresentKeyVisitor : public FieldVisitor {
 public:
  /// @param prefix  prepended to all names: "light."
  explicit PresentKeyVisitor(std::string prefix = "") : prefixes_{std::move(prefix)} {}

 protected:
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
  /// Prefix of the visited key: "light.impulse_response.".
  const std::string& prefix() const { return prefixes_.back(); }

 private:
  std::vector<std::string> prefixes_;
};

class RangeCheck : public PresentKeyVisitor {
 public:
  using PresentKeyVisitor::PresentKeyVisitor;

 protected:
  /// @throws InvalidArgument "light.peak_factor = 0; must be finite and >= 1"
  void visit(const Key& key, const Value& value) override;
};

/// Checks the range of every number.
/// @param prefix  prepended to keys in errors: "light."
/// @throws InvalidArgument "light.peak_factor = 0; must be finite and >= 1"
template <typename Struct>
void check_ranges(Struct its, std::string prefix = "") {
  RangeCheck check(std::move(prefix));
  describe(check, its);
}

/// Collects notes on numbers outside Key::usually(), which suggest a wrong unit or power of ten.
class UnusualNumbers : public PresentKeyVisitor {
 public:
  /// "exposure_s = 20 s; most cameras have 1e-05 to 1 s: is the unit right?"
  std::vector<std::string> notes;

 protected:
  void visit(const Key& key, const Value& value) override;
};

template <typename Struct>
std::vector<std::string> unusual_numbers(Struct its) {
  UnusualNumbers visitor;
  describe(visitor, its);
  return std::move(visitor.notes);
}

}  // namespace tofsmith

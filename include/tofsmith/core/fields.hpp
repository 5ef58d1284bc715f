// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/range.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/core/words.hpp"

namespace tofsmith {

// Fields of options and results are listed once, next to the struct, in the order of declaration:
//
//   auto fields_of(ConstOrNot<OptimizeOptions> auto& o) {
//     return std::tuple(Field("starts", o.starts, at_least(1), ByEffort{2}),
//                       Field("polish", o.polish));
//   }
//
// Validation, keys of finished work, JSON, command line options, Python keyword arguments and
// effort use for_each_field(), which does not compile if a field is missing.

/// Properties of a field besides its type.
enum class FieldMark : unsigned {
  from_above = 1,     ///< set by the enclosing struct
  apart = 2,          ///< elsewhere in the JSON document
  in_place = 4,       ///< its fields are part of the enclosing object
  without_error = 8,  ///< an estimate whose standard error is not reported
  as_object = 16,     ///< an estimate, or each item of a list, that is a separate object
  may_be_null = 32,   ///< in JSON
  bound = 64          ///< an error bound, which some tables omit
};
constexpr unsigned as_bits(FieldMark mark) { return static_cast<unsigned>(mark); }

/// A count that is scaled by effort, down to this minimum.
struct ByEffort {
  int min = 0;
};

/// Noun phrase, or imperative for a flag, without unit, range, words and default.
struct Help {
  std::string_view text;
};

/// Describes the value of an absent optional field: "as many as fit".
struct IfAbsent {
  std::string_view text;
};

/// Condition of a field: "method unwrap".
struct OnlyWith {
  std::string_view condition;
};

/// Name in JSON documents, if different.
struct InDocuments {
  std::string_view name;
};

/// Returns a help text with unit, default and condition, of which each may be empty: "longest delay
/// of a second return [m] (default: a third of the range)".
std::string full_help(std::string_view unit, std::string_view help, std::string_view only_with,
                      std::string_view if_absent);

/// A field of a struct: name, reference to the value, range of numbers, and marks.
template <typename Value>
struct Field {
  const char* name;
  Value& value;
  Range range = {};
  std::optional<ByEffort> by_effort = {};
  std::string_view help = {};
  std::string_view if_absent = {};
  std::string_view only_with = {};
  std::string_view document_name = name;
  unsigned marks = 0;

  template <typename... Marks>
  Field(const char* its_name, Value& its_value, Marks... its_marks)
      : name(its_name), value(its_value) {
    (set(its_marks), ...);
  }
  bool is(FieldMark mark) const { return (marks & as_bits(mark)) != 0; }
  /// "" for plain numbers.
  std::string_view unit() const;

 private:
  void set(const Range& its_range) { range = its_range; }
  void set(ByEffort effort) { by_effort = effort; }
  void set(Help its) { help = its.text; }
  void set(IfAbsent its) { if_absent = its.text; }
  void set(OnlyWith its) { only_with = its.condition; }
  void set(InDocuments its) { document_name = its.name; }
  void set(FieldMark mark) { marks |= as_bits(mark); }
};

template <typename Type, typename Struct>
concept ConstOrNot = std::is_same_v<std::remove_const_t<Type>, Struct>;

template <typename Struct>
concept HasFields = requires(Struct& its) {
  fields_of(its);
};

/// Two numbers, written as "3/8" on the command line and as (3, 8) in Python: a described struct
/// with a `rule`, is_valid(), and a `separator` and an `example` for the command line.
template <typename Struct>
concept NumberPair = HasFields<Struct> && requires {
  Struct::separator;
};
template <NumberPair Pair>
using NumberOf = std::remove_cvref_t<decltype(std::get<0>(fields_of(std::declval<Pair&>())).value)>;

namespace detail {
template <typename Struct, typename Listed>
inline constexpr bool lists_all = false;
/// True if the struct can be initialized from the listed values, but not from one more.
template <typename Struct, typename... Values>
inline constexpr bool lists_all<Struct, std::tuple<Field<Values>...>> = requires {
  Struct{std::declval<Values>()...};
}
&&!requires { Struct{std::declval<Values>()..., {}}; };
}  // namespace detail

/// True if fields_of() lists every member in the order of declaration.
template <typename Struct>
inline constexpr bool lists_every_field =
    detail::lists_all<Struct, decltype(fields_of(std::declval<Struct&>()))>;

/// True if all members of a struct are doubles.
template <typename Struct>
inline constexpr bool is_row =
    std::is_same_v<decltype(std::apply(
                       [](const auto&... fields) {
                         return std::bool_constant<(
                             std::is_same_v<decltype(fields.value), double&> && ...)>();
                       },
                       fields_of(std::declval<Struct&>()))),
                   std::true_type>;

template <typename Struct, typename Visit>
void for_each_field(Struct& its, Visit&& visit) {
  static_assert(lists_every_field<std::remove_const_t<Struct>>,
                "fields_of() must list every member in the order of declaration");
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, fields_of(its));
}

/// Name of the standard error of an estimate: "error_se_m" for "error_m", "linear_se_m" for
/// "linear_mde_m".
std::string error_name(std::string_view name);

template <typename Value>
inline constexpr bool is_list = false;
template <typename Item>
inline constexpr bool is_list<std::vector<Item>> = true;
template <typename Value>
inline constexpr bool is_optional = false;
template <typename Value>
inline constexpr bool is_optional<std::optional<Value>> = true;

namespace detail {
template <typename Value>
struct SingleValueOf {
  using Type = Value;
};
template <typename Item>
struct SingleValueOf<std::vector<Item>> {
  using Type = Item;
};
template <typename Content>
struct SingleValueOf<std::optional<Content>> {
  using Type = Content;
};
}  // namespace detail

/// Item type of a list or an optional value; else the type itself.
template <typename Value>
using SingleValue = typename detail::SingleValueOf<Value>::Type;

namespace detail {
template <typename Value>
void check(const char* name, const Value& value, const Range& range, std::string_view owner,
           std::string_view which = "must be ") {
  if constexpr (std::is_arithmetic_v<Value>) {
    if (!range.contains(static_cast<double>(value)))
      require(false, std::string(owner) + name, value,
              std::string(which) + range.text(std::is_integral_v<Value>));
  } else if constexpr (is_list<Value>) {
    for (const auto& item : value) check(name, item, range, owner, "each must be ");
  } else if constexpr (is_optional<Value>) {
    if (value) check(name, *value, range, owner);
  } else if constexpr (NumberPair<Value>) {
    const auto [first, second] = fields_of(value);
    require(value.is_valid(), std::string(owner) + name,
            describe(first.value) + Value::separator + describe(second.value),
            "must be " + std::string(Value::rule));
  }
}
}  // namespace detail

template <typename Value>
std::string_view Field<Value>::unit() const {
  using Single = SingleValue<std::remove_const_t<Value>>;
  constexpr bool is_number = std::is_arithmetic_v<Single> && !std::is_same_v<Single, bool>;
  return is_number ? unit_of_key(name) : std::string_view();
}

/// Checks the range of every field; struct members other than pairs check themselves.
/// @param owner  prepended to names in errors: "OptimizeOptions::"
/// @throws InvalidArgument "OptimizeOptions::starts = -3; must be >= 1"
template <typename Struct>
void check_fields(const Struct& its, std::string_view owner = "") {
  for_each_field(
      its, [&](const auto& field) { detail::check(field.name, field.value, field.range, owner); });
}

/// Returns a count times `effort`, rounded, at least the minimum.
int scaled_count(int count, double effort, ByEffort by_effort);

/// Scales counts marked ByEffort, also in struct members.
template <typename Struct>
void scale_by_effort(Struct& its, double effort) {
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_reference_t<decltype(field.value)>;
    if constexpr (HasFields<Value>)
      scale_by_effort(field.value, effort);
    else if constexpr (std::is_same_v<Value, int>)
      if (field.by_effort) field.value = scaled_count(field.value, effort, *field.by_effort);
  });
}

}  // namespace tofsmith

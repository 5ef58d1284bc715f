// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/arrays/shared/correction_arrays.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Includes the fields of nested DepthErrorTerms.
template <typename Struct, typename Visit>
void for_each_array(Struct& its, const std::string& prefix, const Visit& visit) {
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    const std::string name = prefix + field.name;
    if constexpr (std::is_same_v<Value, DepthErrorTerms>)
      for_each_array(field.value, name + "_", visit);
    else
      visit(name, field.value);
  });
}

std::vector<double> read_numbers(const NpzReader& archive, const std::string& file,
                                 const std::string& name) {
  const NpyArray array = archive.read(name);
  if (array.axes() > 1)
    throw IoError(fmt::format("{}: {}", file, name),
                  fmt::format("found the shape {}; expected one number or a list",
                              describe_shape(array.shape())));
  return array.to_doubles();
}

}  // namespace

void add_correction(const DepthCorrection& correction, NpzArrays& arrays) {
  for_each_array(correction, std::string(correction_prefix),
                 [&](const std::string& name, const auto& value) {
                   std::vector<double> numbers;
                   NpyShape shape;
                   if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                     numbers = {static_cast<double>(value)};
                   } else {
                     numbers.assign(value.data(), value.data() + value.size());
                     shape = {numbers.size()};
                   }
                   arrays.emplace(name, NpyArray::of<double>(shape, numbers));
                 });
}

std::optional<DepthCorrection> correction_of(const NpzReader& archive, const std::string& file) {
  if (!archive.contains(std::string(correction_prefix) + "height")) return std::nullopt;
  DepthCorrection correction;
  for_each_array(
      correction, std::string(correction_prefix), [&](const std::string& name, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        const std::vector<double> numbers = read_numbers(archive, file, name);
        if constexpr (std::is_arithmetic_v<Value>) {
          constexpr auto largest = static_cast<double>(std::numeric_limits<Value>::max());
          if (numbers.size() != 1 || !(std::abs(numbers[0]) <= largest))
            throw IoError(fmt::format("{}: {}", file, name), "expected one finite number");
          value = static_cast<Value>(numbers[0]);
        } else {
          value = Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                                    static_cast<Eigen::Index>(numbers.size()));
        }
      });
  try {
    correction.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(file, error.what());
  }
  return correction;
}

}  // namespace tofsmith

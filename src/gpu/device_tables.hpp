// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decode/filter/shared/filter_parts.hpp"
#include "decode/output/shared/decoder_parts.hpp"
#include "gpu/kernel_parameters.h"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

class TableWords {
 public:
  explicit TableWords(std::vector<std::uint32_t>& words) : words_(words) {}

  /// @return offset of the table [words]
  template <typename Value>
  int add(std::span<const Value> table) {
    static_assert(sizeof(Value) % sizeof(std::uint32_t) == 0);
    constexpr std::size_t line = 16;  // words
    const std::size_t at = (words_.size() + line - 1) / line * line;
    require(at + table.size_bytes() / 4 < std::size_t{std::numeric_limits<int>::max()},
            "words of decoding tables", at, "must be below 2^31 on a device");
    words_.resize(at + table.size_bytes() / sizeof(std::uint32_t));
    if (!table.empty()) std::memcpy(&words_[at], table.data(), table.size_bytes());
    return static_cast<int>(at);
  }
  template <typename Value>
  int add(const std::vector<Value>& table) {
    return add(std::span<const Value>(table));
  }

 private:
  std::vector<std::uint32_t>& words_;
};

/// Source of the kernels.
extern const std::string_view decode_kernels;

struct DecodeTables {
  DecodeTables(const Decoder& decoder, bool has_doubles);

  MatchParameters points;  ///< find the bins next to the best points on the chords
  MatchParameters bins;    ///< find the best bins of a coarse table, else as `points`
  bool is_coarse = false;
  OutputParameters outputs;
  std::vector<std::uint32_t> words;  ///< contents of all tables
  std::string options;               ///< of the compiler
};

/// Source of the kernels without their constants.
extern const std::string_view filter_kernels;

struct FilterTables {
  FilterTables(const Filter::Plan& plan, bool fuses);

  FilterParameters parameters{};     ///< without the size of the frame
  std::vector<std::uint32_t> words;  ///< of all tables
  std::string source;                ///< of the kernels, with their constants
};

/// First plane of a light set, and plane of the variance that depths were decoded from.
int light_plane(int set, int measurements);
int before_plane(int measurements);

}  // namespace tofsmith

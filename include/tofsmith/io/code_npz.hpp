// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// How the K columns of an array run through E exposures of several taps.
enum class TapOrder {
  blocked,      ///< tap 0 of all exposures, then tap 1 of all exposures, ..
  interleaved,  ///< all taps of exposure 0, then all taps of exposure 1, ..
};

/// What an NPZ file does not say about its columns.
struct TapLayout {
  int taps = 1;
  std::optional<TapOrder> order;  ///< must be given for several taps: it is never guessed
};

/// Reads the arrays `modfs` and `demodfs`, each (N, K), in the layout that other time-of-flight
/// projects publish: a column of each for every measurement. A column of two levels, the lower of
/// which is 0, becomes a binary waveform; modulation keeps its scale. `corrfs` is not needed, but
/// must have the same shape.
/// @param file  what errors call it; its stem becomes the code's name
/// @throws IoError naming file, array, row and column for shapes that disagree, values that no
///         code can have, taps of one exposure with different modulation, or several taps without
///         an order
CodeSet parse_code_npz(std::span<const std::byte> content, std::string_view file,
                       const TapLayout& layout = {});

/// The same layout: modulation and demodulation as cell averages, and
///   corrfs[z, i] = (1/N) sum_n modfs[n, i] demodfs[n + z, i],
/// the correlation without a camera's impulse responses.
/// @throws std::invalid_argument if the code has several taps and there is no order
std::vector<std::byte> serialize_code_npz(const CodeSet& code,
                                          std::optional<TapOrder> order = std::nullopt);

}  // namespace tofsmith

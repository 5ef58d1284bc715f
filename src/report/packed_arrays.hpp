// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "report/plotly_json.hpp"

namespace tofsmith::plotly {

/// The large arrays of a page's figures, each once and deflated; src/report/page.js unpacks them.
///
/// An array with a step is rounded to whole multiples of it and kept as q = value / step - low + 1,
/// 0 where there is no value; one without keeps the bits of its floats. Either way the first bytes
/// of all numbers come first, then the second ones, and so on. `is_difference`: along a row each
/// number is that beyond the one before, without its carry.
class PackedArrays {
 public:
  /// Takes the typed arrays and long lists of numbers, as single floats, out of a figure's JSON;
  /// {"packed": i} stands for array i.
  void take_from(Json& json);
  /// [{"shape", "bytes", "is_difference", "data"; "step", "low" if rounded} ..].
  const Json& json() const { return arrays_; }

 private:
  std::size_t place_of(const Json& typed);

  Json arrays_ = Json::array();
  std::map<std::string, std::size_t> places_;  // of what was taken
};

}  // namespace tofsmith::plotly

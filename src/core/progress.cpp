// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void report(const Progress& progress, double fraction, std::string_view step) {
  if (progress && !progress(fraction, step)) throw Interrupted();
}

Progress part_of(const Progress& whole, double begin, double end) {
  if (!whole) return {};
  return [whole, begin, end](double fraction, std::string_view step) {
    return whole(begin + (end - begin) * fraction, step);
  };
}

}  // namespace tofsmith

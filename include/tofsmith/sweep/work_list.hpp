// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/sweep/sweep_spec.hpp"

namespace tofsmith {

/// Changes whenever the same settings give other results, so that old stores are not trusted.
inline constexpr int sweep_result_version = 2;

/// One depth error to find.
struct WorkItem {
  /// 32 hexadecimal digits: a hash of everything that determines the result (the camera with its
  /// responses as samples, the code's waveforms, decoder, operating points, seed, trials, version
  /// of results), and of nothing else: not of names, files or places in a list.
  std::string key;
  Camera camera;
  CodeSet code;
  EvaluateOptions options;
};

/// The items of a sweep.
class WorkList {
 public:
  explicit WorkList(SweepSpec spec) : spec_(std::move(spec)), size_(spec_.items()) {}

  const SweepSpec& spec() const { return spec_; }
  std::int64_t size() const { return size_; }

  /// The code of an item, as it is called there: a family's name or a file.
  std::string code_name(std::int64_t item) const;
  /// What is particular about an item, as one line of JSON: {"code": "square-k4", "samples": 120}.
  std::string settings_json(std::int64_t item) const;

  /// Reads and builds what an item needs.
  /// @throws IoError for files that cannot be read, values that no camera can have and codes that
  ///         its camera cannot play, naming the value's place and the item
  WorkItem item(std::int64_t item) const;

  /// The keys of all items, each of which is so checked.
  /// @throws IoError as item(); Interrupted if progress says so
  std::vector<std::string> keys(const Progress& progress = {}) const;

 private:
  SweepSpec spec_;
  std::int64_t size_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "session.hpp"

namespace tofsmith::apps {

/// Options that replace the operating points by light from the camera's [optics]: `--distance`,
/// `--albedo`, `--klux`.
class DistanceArguments {
 public:
  void add_to(CLI::App& command);

  bool is_asked() const { return !distances_m_.empty(); }
  /// Returns the camera at the given distances, and prints the light at each.
  /// @throws InvalidArgument for a camera without optics
  Camera at(const Camera& camera, const Session& session) const;

 private:
  std::vector<double> distances_m_;
  double albedo_ = 1.0;
  std::optional<double> klux_;
};

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "session.hpp"

namespace tofsmith::apps {

/// Light by the camera's [optics] instead of its operating points: `--distance`, `--albedo`,
/// `--klux`.
class DistanceArguments {
 public:
  void add_to(CLI::App& command);

  bool is_asked() const { return !distances_m_.empty(); }
  /// The camera at the distances asked for, and a line for each that says which light that is.
  /// @throws InvalidArgument for a camera without optics
  Camera at(const Camera& camera, const Session& session) const;

 private:
  std::vector<double> distances_m_;
  double albedo_ = 1.0;
  std::optional<double> klux_;
};

}  // namespace tofsmith::apps

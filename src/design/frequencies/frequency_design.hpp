// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Adds the best square-wave codes at frequencies of camera.light.square as candidates, with more
/// phases and other splits of the time by trials, and the rule of thumb.
/// @throws InvalidArgument if the camera has no such codes; Interrupted
void add_frequency_candidates(const Camera& camera, const DesignOptions& options,
                              DesignResult& result, const Progress& progress);

/// Compares the error of the winner with the best binary code among families and atlas, if any.
std::optional<std::string> price_of_frequencies(const Camera& camera, const DesignOptions& options,
                                                const DesignResult& result,
                                                const Progress& progress);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Adds square-wave codes at frequencies of camera.light.square as candidates: the best codes of a
/// search of all sets of frequencies, after trials of more phases and other splits of the time, and
/// the first choice of the usual rule of thumb.
/// @throws InvalidArgument if the camera has no such codes; Interrupted
void add_frequency_candidates(const Camera& camera, const DesignOptions& options,
                              DesignResult& result, const Progress& progress);

/// Returns a sentence that compares the error of the winner with the error of the best binary code
/// of the atlas and the families for the camera; none: there is no such code.
std::optional<std::string> price_of_frequencies(const Camera& camera, const DesignOptions& options,
                                                const DesignResult& result,
                                                const Progress& progress);

}  // namespace tofsmith

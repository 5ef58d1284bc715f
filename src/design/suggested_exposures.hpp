// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Returns the highest harmonic at which both arms together have a gain of at least 1/25 (1/5 per
/// arm in the paper); 0 without band limit.
int useful_harmonics(const Camera& camera);

}  // namespace tofsmith

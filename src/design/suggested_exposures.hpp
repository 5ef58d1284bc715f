// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The highest harmonic of which both arms together leave at least 1/25, what the paper calls the
/// end of the band (each arm 1/5); 0 without a band limit.
int useful_harmonics(const Camera& camera);

}  // namespace tofsmith

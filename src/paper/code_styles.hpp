// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// How a code is drawn in every figure of the paper: the family gives the colour (safe for any
/// colour vision), the variant the dash: ideal codes dashed, naive ones dotted, all else solid.
/// One-tap codes beside two-bucket ones are dash-dotted. Codes: hamiltonian-k3 .. k8, sinusoid,
/// square, multifrequency, pulsed-multifrequency, each with whatever follows, such as
/// "hamiltonian-k4-redesigned" or "hamiltonian-k4-ideal".
LineStyle style_of_code(std::string_view code);

}  // namespace tofsmith

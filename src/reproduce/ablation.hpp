// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

namespace tofsmith {

/// Sec. 5.1: the alternation without total variation, with it, and projected to binary waveforms,
/// from the same random starts. Adds findings, a section and data.
void add_total_variation_ablation(Reproduction& result, const ReproduceContext& context);

}  // namespace tofsmith

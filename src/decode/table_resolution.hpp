// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Rows of a decoding table that determine all of the model's correlation functions, at least N.
///   - Where these are sums of harmonics: 8/3 rows or more for the highest one that counts.
///   - Without impulse responses: the fewest that include all corners, up to 32 N; else N.
int sufficient_rows(const ForwardModel& model);

/// make_decoding_table() of a correlation (N, K), with just these rows.
DecodingTable table_of_rows(const Eigen::MatrixXd& correlation, double range_m);

/// Returns the table with as many rows as decoders need, and the same bins. Smooth tables are
/// interpolated until depths between rows are accurate to 20 um, rounding to single precision
/// included, and rows are at most 15 degrees apart. Other tables are returned unchanged, since
/// nothing is known between their rows.
DecodingTable resolved(const DecodingTable& table);

}  // namespace tofsmith

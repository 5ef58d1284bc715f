// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Returns the number of rows, at least N, that determine all correlation functions of the model:
/// - sums of harmonics: at least 8/3 rows per period of the highest significant harmonic;
/// - without impulse responses: the least number up to 32 N that includes all corners, or N.
int sufficient_rows(const ForwardModel& model);

/// As make_decoding_table() of a correlation (N, K), without additional rows.
DecodingTable table_of_rows(const Eigen::MatrixXd& correlation, double range_m);

/// Returns the table with the resolution that decoders need, and the same bins. Smooth tables are
/// interpolated until depths between rows are accurate to 20 um and adjacent rows are at most 15
/// degrees apart. Other tables are unchanged.
DecodingTable resolved(const DecodingTable& table);

}  // namespace tofsmith

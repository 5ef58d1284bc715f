// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tofsmith/io/npy.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// A finished item of a sweep.
struct SweepResult {
  std::int64_t item = 0;
  std::string key;
  DepthErrorReport error;
};

/// The finished items, in the order of the list: whenever and by whomever they were computed, the
/// same results give the same bytes in every export.
/// @param keys  of all items, WorkList::keys()
/// @throws IoError if the store is damaged
std::vector<SweepResult> sweep_results(const WorkList& list, std::span<const std::string> keys,
                                       SweepStore& store);

/// A row for each item and operating point: the value of every axis, errors and bounds in metres.
std::string sweep_csv(const WorkList& list, std::span<const SweepResult> results);

/// The axes, and one entry per item with its settings and its result as `tofsmith evaluate` gives
/// them.
/// @param target  instruction set of the results
std::string sweep_json(const WorkList& list, std::span<const SweepResult> results,
                       std::string_view target);

/// The columns of the CSV file as arrays of one length. An axis of texts is `NAME_index` into
/// `NAME_names`, an array of UTF-8 bytes, padded with zeros (in NumPy:
/// names.view(f"S{names.shape[1]}").ravel()).
NpzArrays sweep_arrays(const WorkList& list, std::span<const SweepResult> results);

}  // namespace tofsmith

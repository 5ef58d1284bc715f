// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Headings come first. Columns are numeric unless listed in `text_columns`.
inline Table table_of_rows(std::string id, std::string caption,
                           const std::vector<std::vector<std::string>>& rows,
                           std::initializer_list<std::size_t> text_columns) {
  Table table{.id = std::move(id), .caption = std::move(caption)};
  for (std::size_t i = 0; i < rows.front().size(); ++i)
    table.columns.push_back(
        {rows.front()[i], std::ranges::find(text_columns, i) == text_columns.end()});
  table.rows.assign(rows.begin() + 1, rows.end());
  return table;
}

}  // namespace tofsmith

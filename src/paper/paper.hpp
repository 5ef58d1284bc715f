// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "paper/context.hpp"
#include "paper/reproduction.hpp"

namespace tofsmith {

/// One figure, table or group of statements of the paper.
struct PaperItem {
  std::string name;   ///< "fig3", "table1", "text"
  std::string title;  ///< what it shows, in a few words
  Reproduction (*reproduce)(const ReproduceContext&, const Progress&);
  double share = 1.0;       ///< of the whole work, relative: for progress
  bool shows_mesh = false;  ///< depends on ReproduceOptions::mesh
};

/// All of them, in the paper's order.
std::span<const PaperItem> paper_items();

/// The item of that name. @throws std::invalid_argument with the nearest name there is
const PaperItem& paper_item(std::string_view name);

/// The item's page: findings first, then what it shows, then where the data is.
Page reproduction_page(const PaperItem& item, const Reproduction& reproduction,
                       const ReproduceOptions& options);

}  // namespace tofsmith

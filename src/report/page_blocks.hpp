// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "tofsmith/report/page.hpp"

namespace tofsmith::page_blocks {

/// The numbers of figures and tables, by id, in the order they stand on the page.
class Numbering {
 public:
  /// @throws std::invalid_argument if an id is used twice
  explicit Numbering(const Page& page);

  /// "Figure 3", "Table 1".
  /// @throws std::invalid_argument if nothing has this id
  const std::string& label(const std::string& id) const;
  /// The same for a table, which may have no id.
  const std::string& label(const Table& table) const;

 private:
  std::map<std::string, std::string> labels_;
  std::map<const Table*, std::string> table_labels_;
};

/// A block as HTML.
/// @throws std::invalid_argument if a table row does not fit its columns or [[id]] names nothing
std::string html(const Block& block, const Numbering& numbering);

}  // namespace tofsmith::page_blocks

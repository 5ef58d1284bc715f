// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "paper/paper.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::test {

/// The item, made coarsely.
inline Reproduction coarsely(std::string_view name) {
  CodeShelf shelf;
  const ReproduceOptions options{.fast = true};
  return paper_item(name).reproduce({options, shelf}, {});
}

/// The finding whose statement contains `words`.
inline const CheckedStatement& finding_about(const Reproduction& reproduction,
                                             std::string_view words) {
  for (const CheckedStatement& finding : reproduction.findings)
    if (finding.statement.find(words) != std::string::npos) return finding;
  throw std::logic_error("no finding about " + std::string(words));
}

inline Verdict verdict_on(const Reproduction& reproduction, std::string_view words) {
  return finding_about(reproduction, words).verdict;
}

/// An array's values, with its shape checked.
inline std::vector<double> values_of(const Reproduction& reproduction, const std::string& name,
                                     const std::vector<std::size_t>& shape) {
  const NpyArray& array = reproduction.arrays.at(name);
  EXPECT_EQ(array.shape(), shape) << name;
  return array.to_doubles();
}

/// The item's page as HTML; throws where figures, tables and links do not fit together.
inline std::string rendered(std::string_view name, const Reproduction& reproduction) {
  return render(reproduction_page(paper_item(name), reproduction, {.fast = true}));
}

}  // namespace tofsmith::test

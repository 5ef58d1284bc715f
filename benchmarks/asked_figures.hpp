// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace tofsmith::benchmarks {

/// Collects measured values with their targets.
class AskedFigures {
 public:
  void at_least(const std::string& what, double measured, double asked) {
    figures_.push_back({what, measured, asked, measured >= asked, ">="});
  }
  void at_most(const std::string& what, double measured, double asked) {
    figures_.push_back({what, measured, asked, measured <= asked, "<="});
  }

  void print() const {
    if (figures_.empty()) return;
    fmt::print("\n{:<66}{:>10}{:>13}{:>11}\n", "asked", "measured", "asked", "ratio");
    for (const Figure& figure : figures_)
      fmt::print("{:<66}{:>10.4g}{:>5}{:>8.4g}{:>11.2f}{}\n", figure.what, figure.measured,
                 figure.relation, figure.asked, figure.measured / figure.asked,
                 figure.is_met ? "" : "   missed");
  }

 private:
  struct Figure {
    std::string what;
    double measured, asked;
    bool is_met;
    const char* relation;
  };
  std::vector<Figure> figures_;
};

}  // namespace tofsmith::benchmarks

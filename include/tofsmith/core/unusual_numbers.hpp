// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Collects notes on numbers outside Key::usually(), which suggest a wrong unit or power of ten.
class UnusualNumbers : public PresentKeyVisitor {
 public:
  /// "exposure_s = 20 s; most cameras have 1e-05 to 1 s: is the unit right?"
  std::vector<std::string> notes;

 protected:
  void visit(const Key& key, const Value& value) override;
};

template <typename Struct>
std::vector<std::string> unusual_numbers(Struct its) {
  UnusualNumbers visitor;
  describe(visitor, its);
  return std::move(visitor.notes);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Collects notes on numbers far outside the range that most cameras have (Key::usually()): a wrong
/// unit or power of ten.
class UnusualNumbers : public FieldVisitor {
 public:
  /// "exposure_s = 20 s; most cameras have 1e-05 to 1 s: is the unit right?"
  std::vector<std::string> notes;

 protected:
  void visit(const Key& key, const Value& value) override;
  bool wants(const Key& /*key*/, bool is_there) override { return is_there; }
  void refuse(const Key& /*key*/, const Value& /*value*/) override {}
  bool enter(const Key& key) override {
    prefixes_.push_back(prefixes_.back() + std::string(key.name) + ".");
    return true;
  }
  void leave() override { prefixes_.pop_back(); }
  bool enter_part(const Key&, std::span<const std::string>, bool is_there) override {
    return is_there;
  }

 private:
  std::vector<std::string> prefixes_{""};
};

/// Notes on unusual numbers of a described struct.
template <typename Struct>
std::vector<std::string> unusual_numbers(Struct its) {
  UnusualNumbers visitor;
  describe(visitor, its);
  return std::move(visitor.notes);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Writes the fields in order. Absent values and empty tables are omitted. NaN and infinity in
/// lists of raw numbers are written as words.
class FieldWriter : public FieldVisitor {
 public:
  const nlohmann::ordered_json& document() const { return tables_.front(); }

 protected:
  void visit(const Key& key, const Value& value) override;
  bool wants(const Key& /*key*/, bool is_there) override { return is_there; }
  void refuse(const Key& /*key*/, const Value& /*value*/) override {}
  bool enter(const Key& key) override;
  void leave() override;
  bool enter_part(const Key&, std::span<const std::string>, bool is_there) override {
    return is_there;
  }

 private:
  std::vector<nlohmann::ordered_json> tables_{nlohmann::ordered_json::object()};
  std::vector<std::string> names_;
};

template <typename Struct>
nlohmann::ordered_json described_json(Struct its) {
  FieldWriter writer;
  describe(writer, its);
  return writer.document();
}

}  // namespace tofsmith

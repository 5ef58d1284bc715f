// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <map>

#include "io/text/shared/reader.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Missing keys leave values unchanged. Errors are as in TableReader.
class FieldReader : public FieldVisitor {
 public:
  /// @param table  must outlive the reader, and must be finished by the caller
  explicit FieldReader(TableReader& table) : outer_(table) {}

  /// Absolute paths by the full name of the key, such as "lens.rays".
  const std::map<std::string, std::filesystem::path>& files() const { return files_; }

 protected:
  void visit(const Key& key, const Value& value) override;
  bool wants(const Key& key, bool is_there) override;
  void refuse(const Key& key, const Value& value) override;
  bool enter(const Key& key) override;
  void leave() override;
  bool enter_part(const Key& key, std::span<const std::string> names, bool is_there) override;

 private:
  TableReader& table() { return inner_.empty() ? outer_ : inner_.back(); }

  TableReader& outer_;
  std::list<TableReader> inner_;  ///< entered tables, the current one last
  std::map<std::string, std::filesystem::path> files_;
};

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

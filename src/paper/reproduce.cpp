// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/reproduction_directory.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

std::vector<const PaperItem*> paper_items_named(std::span<const std::string> names) {
  std::vector<const PaperItem*> items;
  for (const std::string& name : names) {
    if (name == "all") {
      items.clear();
      for (const PaperItem& item : paper_items()) items.push_back(&item);
      return items;
    }
    items.push_back(&paper_item(name));
  }
  return items;
}

std::vector<ReproducedItem> reproduce(const ReproductionDirectory& directory,
                                      std::span<const PaperItem* const> items,
                                      const ReproduceOptions& options, bool again,
                                      const Progress& progress) {
  make_output_directory(directory.path());
  if (!again) directory.require_ours(options);
  CodeShelf shelf(directory.shelf());
  const ReproduceContext context{options, shelf};
  std::vector<double> shares;
  for (const PaperItem* item : items) shares.push_back(item->share);
  const ProgressParts parts(progress, shares);
  std::vector<ReproducedItem> reproduced;
  for (const PaperItem* item : items) {
    const Progress part = parts[reproduced.size()];
    auto findings = again ? std::nullopt : directory.finished(*item, options);
    const bool kept = findings.has_value();
    if (!kept) {
      report(part, 0.0, item->name);
      Reproduction reproduction = item->reproduce(context, part);
      directory.write(*item, reproduction, options);
      directory.write_index(options);
      findings = std::move(reproduction.findings);
    }
    reproduced.push_back({item, std::move(*findings), kept});
  }
  directory.write_index(options);
  report(progress, 1.0, "done");
  return reproduced;
}

}  // namespace tofsmith

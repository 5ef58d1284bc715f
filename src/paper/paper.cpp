// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/paper.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "paper/figures.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

std::span<const PaperItem> paper_items() {
  static const std::vector<PaperItem> items = {
      {"fig2", "From a target to functions that can be played", reproduce_fig2, 2},
      {"fig3", "Hamiltonian codes at falling peak power", reproduce_fig3, 10},
      {"fig4", "Mean depth error over signal and ambient light", reproduce_fig4, 110},
      {"fig5", "Impulse responses and their band limits", reproduce_fig5, 0.1},
      {"fig6", "Two K = 5 codes at 10 f0", reproduce_fig6, 1},
      {"fig7", "A hand under loose and tight limits", reproduce_fig7, 2, true},
      {"fig8", "Two-bucket cameras", reproduce_fig8, 45},
      {"fig9", "A single pixel on the bench", reproduce_fig9, 8},
      {"fig10", "Scenes scanned by the prototype", reproduce_fig10, 12},
      {"fig11", "A wall scanned by the prototype", reproduce_fig11, 2},
      {"table1", "The bench's parameters", reproduce_table1, 5},
      {"text", "Statements in the text", reproduce_text, 12},
  };
  return items;
}

const PaperItem& paper_item(std::string_view name) {
  const auto items = paper_items();
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const PaperItem& item) { return item.name == name; });
  if (found != items.end()) return *found;
  std::vector<std::string> names;
  for (const PaperItem& item : items) names.push_back(item.name);
  const std::string near = nearest_word(std::string(name), names);
  reject("figure", name,
         fmt::format("must be all or one of {}{}", fmt::join(names, ", "),
                     near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

Page reproduction_page(const PaperItem& item, const Reproduction& reproduction,
                       const ReproduceOptions& options) {
  Page page{.title = item.title,
            .subtitle =
                fmt::format("{} of Gutierrez-Barragan et al., Practical Coding Function Design for "
                            "Time-of-Flight Imaging, CVPR 2019, reproduced{}",
                            item.name, options.fast ? ". Coarse (--fast): few trials" : ""),
            .footer = fmt::format("tofsmith {}, seed {}{}", TOFSMITH_VERSION, options.seed,
                                  options.fast ? ", coarse (--fast)" : "")};
  if (!reproduction.findings.empty())
    page.sections.push_back(
        {"What the paper states, and what we find", {CheckedStatementList{reproduction.findings}}});
  page.sections.insert(page.sections.end(), reproduction.sections.begin(),
                       reproduction.sections.end());
  LinkList data;
  if (!reproduction.arrays.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, array] : reproduction.arrays)
      names.push_back(fmt::format("`{}` {}", name, describe_shape(array.shape())));
    data.entries.push_back({"data.npz", "data.npz", fmt::format("{}", fmt::join(names, ", "))});
  }
  for (const auto& [name, content] : reproduction.files) data.entries.push_back({name, name, ""});
  data.entries.push_back({"All figures", "../index.html", ""});
  page.sections.push_back({"Data", {std::move(data)}});
  return page;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "options.hpp"
#include "paper/reproduction_directory.hpp"
#include "progress.hpp"
#include "tofsmith/io/mesh_file.hpp"

namespace tofsmith::python {

namespace {

py::dict statement_dict(const CheckedStatement& statement) {
  py::dict dict;
  dict["verdict"] = std::string(name_of(statement.verdict));
  dict["statement"] = statement.statement;
  dict["measured"] = statement.measured;
  dict["why"] = statement.why;
  return dict;
}

py::dict item_dict(const ReproducedItem& reproduced) {
  py::list findings;
  for (const CheckedStatement& finding : reproduced.findings)
    findings.append(statement_dict(finding));
  py::dict dict;
  dict["name"] = reproduced.item->name;
  dict["title"] = reproduced.item->title;
  dict["verdict"] = std::string(name_of(overall_verdict(reproduced.findings)));
  dict["findings"] = findings;
  dict["kept"] = reproduced.kept;
  return dict;
}

py::list reproduce_items(const std::vector<std::string>& names, const std::string& directory,
                         const py::dict& values, bool overwrite, const py::object& callback) {
  const std::vector<const PaperItem*> items = paper_items_named(names);
  ReproduceOptions options;
  std::string mesh;
  OptionReader(values, "")
      .value("fast", options.fast)
      .value("seed", options.seed)
      .value("mesh", mesh)
      .finish();
  if (!mesh.empty()) {
    options.mesh = read_mesh(mesh);
    options.mesh_name = std::filesystem::path(mesh).filename().string();
  }
  const std::vector<ReproducedItem> reproduced =
      without_gil(callback, [&](const Progress& progress) {
        return reproduce(ReproductionDirectory(directory), items, options, overwrite, progress);
      });
  py::list list;
  for (const ReproducedItem& item : reproduced) list.append(item_dict(item));
  return list;
}

}  // namespace

void bind_reproduce(py::module_& module) {
  module.def("paper_items", [] {
    std::vector<std::pair<std::string, std::string>> items;
    for (const PaperItem& item : paper_items()) items.emplace_back(item.name, item.title);
    return items;
  });
  module.def("reproduce", &reproduce_items);
}

}  // namespace tofsmith::python

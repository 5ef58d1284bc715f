// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/reproduction_directory.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/shared/hash.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

using Json = nlohmann::ordered_json;

/// The options that determine an item.
std::string options_text(const PaperItem& item, const ReproduceOptions& options) {
  std::string mesh;
  if (item.shows_mesh && options.mesh) {
    std::string content = options.mesh_name;
    for (const Eigen::Vector3d& v : options.mesh->vertices)
      content += fmt::format(" {} {} {}", v.x(), v.y(), v.z());
    for (const auto& triangle : options.mesh->triangles)
      content += fmt::format(" {} {} {}", triangle[0], triangle[1], triangle[2]);
    mesh = fmt::format(", mesh {} {:016x}", options.mesh_name, fnv1a_64(content));
  }
  return fmt::format("{}, seed {}{}", options.fast ? "coarse (--fast)" : "full", options.seed,
                     mesh);
}

Json as_json(const std::vector<CheckedStatement>& findings) {
  Json list = Json::array();
  for (const CheckedStatement& finding : findings)
    list.push_back({{"verdict", name_of(finding.verdict)},
                    {"statement", finding.statement},
                    {"measured", finding.measured},
                    {"why", finding.why}});
  return list;
}

Verdict verdict_of(const std::string& name) {
  for (const Verdict verdict : {Verdict::holds, Verdict::in_part, Verdict::fails})
    if (name == name_of(verdict)) return verdict;
  reject("verdict", name, "must be holds, holds in part or does not hold");
}

std::vector<CheckedStatement> findings_of(const Json& document) {
  std::vector<CheckedStatement> findings;
  for (const Json& entry : document.at("findings"))
    findings.push_back({verdict_of(entry.at("verdict").get<std::string>()),
                        entry.at("statement").get<std::string>(),
                        entry.at("measured").get<std::string>(),
                        entry.at("why").get<std::string>()});
  return findings;
}

Page index_page(const ReproductionDirectory& directory, const ReproduceOptions& options) {
  Page page{.title = "The paper, reproduced",
            .subtitle =
                "Gutierrez-Barragan et al., Practical Coding Function Design for "
                "Time-of-Flight Imaging, CVPR 2019: its figures and statements, with our "
                "numbers beside its words",
            .footer = fmt::format("tofsmith {}, seed {}{}", TOFSMITH_VERSION, options.seed,
                                  options.fast ? ", coarse (--fast)" : "")};
  std::array<int, 3> count{};
  for (const PaperItem& item : paper_items()) {
    const auto findings = directory.finished(item, options);
    if (!findings) continue;
    for (const CheckedStatement& finding : *findings)
      ++count[static_cast<std::size_t>(finding.verdict)];
    page.sections.push_back(
        {fmt::format("{}: {}", item.name, item.title),
         {LinkList{{{"Figures, settings and data", item.name + "/index.html", ""}}},
          CheckedStatementList{*findings}}});
  }
  const auto tile = [&](Verdict verdict) {
    return KeyValue{std::string(name_of(verdict)),
                    fmt::format("{}", count[static_cast<std::size_t>(verdict)])};
  };
  page.sections.insert(
      page.sections.begin(),
      {"Statements",
       {KeyNumbers{{tile(Verdict::holds), tile(Verdict::in_part), tile(Verdict::fails)}}}});
  return page;
}

}  // namespace

void ReproductionDirectory::require_ours(const ReproduceOptions& options) const {
  for (const PaperItem& item : paper_items()) {
    const std::filesystem::path file = path_ / item.name / "findings.json";
    if (!std::filesystem::exists(file)) continue;
    const Json document = Json::parse(read_text_file(file), nullptr, false);
    if (document.is_discarded() || !document.contains("options") ||
        document.value("tofsmith", "") != TOFSMITH_VERSION)
      continue;  // damaged or of another version: made again
    const std::string made_with = document.value("options", "");
    if (made_with != options_text(item, options))
      throw IoError(file.string(),
                    fmt::format("was made with other options ({}; now {}); use --force to replace "
                                "it, or another -o",
                                made_with, options_text(item, options)));
  }

  std::vector<std::filesystem::path> pages = {path_ / "index.html"};
  for (const PaperItem& item : paper_items()) pages.push_back(path_ / item.name / "index.html");
  for (const std::filesystem::path& page : pages)
    if (std::filesystem::exists(page) &&
        read_text_file(page).find(R"(<meta name="generator" content="tofsmith">)") ==
            std::string::npos)
      throw IoError(page.string(),
                    "is no page of tofsmith's and would be replaced; use --force, or another -o");
}

std::optional<std::vector<CheckedStatement>> ReproductionDirectory::finished(
    const PaperItem& item, const ReproduceOptions& options) const {
  const std::filesystem::path file = path_ / item.name / "findings.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const Json document = Json::parse(read_text_file(file));
    if (document.at("tofsmith") != TOFSMITH_VERSION ||
        document.at("options") != options_text(item, options))
      return std::nullopt;
    return findings_of(document);
  } catch (const std::exception&) {
    return std::nullopt;  // damaged: made again
  }
}

void ReproductionDirectory::write(const PaperItem& item, const Reproduction& reproduction,
                                  const ReproduceOptions& options) const {
  const std::filesystem::path directory = path_ / item.name;
  make_output_directory(directory);
  std::error_code error;
  // What is there is out of date: without its findings it counts as unfinished.
  std::filesystem::remove(directory / "findings.json", error);
  if (!reproduction.arrays.empty())
    write_npz(directory / "data.npz", reproduction.arrays, OutputPolicy::overwrite);
  for (const auto& [name, content] : reproduction.files)
    write_file_atomically(directory / name, content, OutputPolicy::overwrite);
  write_file_atomically(directory / "index.html",
                        render(reproduction_page(item, reproduction, options)),
                        OutputPolicy::overwrite);
  const Json document = {{"tofsmith", TOFSMITH_VERSION},
                         {"options", options_text(item, options)},
                         {"name", item.name},
                         {"title", item.title},
                         {"findings", as_json(reproduction.findings)}};
  write_file_atomically(directory / "findings.json", document.dump(1) + "\n",
                        OutputPolicy::overwrite);
}

void ReproductionDirectory::write_index(const ReproduceOptions& options) const {
  write_file_atomically(path_ / "index.html", render(index_page(*this, options)),
                        OutputPolicy::overwrite);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/page.hpp"

#include <fmt/format.h>

#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "report/figure_json.hpp"
#include "report/viewer.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using figure_json::Json;

Json entries_json(const std::vector<KeyValue>& entries) {
  Json list = Json::array();
  for (const KeyValue& entry : entries) list.push_back({entry.key, entry.value});
  return list;
}

Json block_json(const Paragraph& paragraph) { return {{"kind", "text"}, {"text", paragraph.text}}; }

Json block_json(const KeyValueList& list) {
  return {{"kind", "settings"}, {"entries", entries_json(list.entries)}};
}

Json block_json(const KeyNumbers& numbers) {
  return {{"kind", "numbers"}, {"entries", entries_json(numbers.entries)}};
}

Json block_json(const Table& table) {
  Json columns = Json::array();
  for (const TableColumn& column : table.columns)
    columns.push_back({{"header", column.header}, {"numeric", column.numeric}});
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    require(table.rows[r].size() == table.columns.size(), fmt::format("Table::rows[{}].size", r),
            table.rows[r].size(),
            fmt::format("must equal columns.size = {}", table.columns.size()));
  Json json = {{"kind", "table"},
               {"id", table.id},
               {"title", table.title},
               {"caption", table.caption},
               {"columns", std::move(columns)},
               {"rows", table.rows}};
  if (table.highlighted_row) json["highlighted"] = *table.highlighted_row;
  return json;
}

Json block_json(const CodeBlock& code) { return {{"kind", "code"}, {"text", code.text}}; }

Json block_json(const Figure& figure) {
  const FigureText& text = figure.text();
  Json json = {{"kind", figure.kind()},
               {"id", text.id},
               {"title", text.title},
               {"caption", text.caption},
               {"alt", text.alt_text.empty() ? text.title : text.alt_text}};
  json.update(Json::parse(figure.json()));
  return json;
}

/// Empty for blocks without id.
std::string id_of(const Block& block) {
  if (const auto* figure = std::get_if<Figure>(&block)) return figure->text().id;
  if (const auto* table = std::get_if<Table>(&block)) return table->id;
  return "";
}

std::string escaped(std::string_view text, std::string_view less_than) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += less_than;
    else if (c == '&' && less_than == "&lt;")
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string page_document(const Page& page) {
  static constexpr std::array layouts = {"open", "folded", "front"};
  std::set<std::string> ids;
  Json sections = Json::array();
  for (const Section& section : page.sections) {
    Json blocks = Json::array();
    for (const Block& block : section.blocks) {
      const std::string id = id_of(block);
      require(id.empty() || ids.insert(id).second, "id", id, "must be used once on a page");
      blocks.push_back(std::visit([](const auto& one) { return block_json(one); }, block));
    }
    sections.push_back({{"title", section.title},
                        {"layout", layouts[static_cast<std::size_t>(section.layout)]},
                        {"blocks", std::move(blocks)}});
  }
  return Json{{"title", page.title},
              {"subtitle", page.subtitle},
              {"footer", page.footer},
              {"sections", std::move(sections)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string render(const Page& page) {
  const std::string_view viewer = viewer_page();
  const auto place = [&](std::string_view mark) {
    const std::size_t at = viewer.find(mark);
    require(at != std::string_view::npos, "viewer page", mark, "must be part of the viewer page");
    return at;
  };
  constexpr std::string_view title_mark = "@TITLE@", document_mark = "@DOCUMENT@";
  const std::size_t title = place(title_mark), document = place(document_mark);
  std::string html(viewer.substr(0, title));
  html += escaped(page.title, "&lt;");
  html += viewer.substr(title + title_mark.size(), document - title - title_mark.size());
  html += escaped(page_document(page), "\\u003c");
  html += viewer.substr(document + document_mark.size());
  return html;
}

}  // namespace tofsmith

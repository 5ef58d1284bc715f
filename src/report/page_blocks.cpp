// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/page_blocks.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/shared/text_numbers.hpp"
#include "report/html.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::page_blocks {
namespace {

using html::escape;

/// Escaped text with `code` and [[id]] replaced by their elements.
std::string inline_html(const std::string& text, const Numbering& numbering) {
  std::string result;
  std::size_t done = 0;
  const auto take = [&](std::size_t end) { result += escape(text.substr(done, end - done)); };
  while (done < text.size()) {
    const std::size_t mark = text.find_first_of("`[", done);
    if (mark == std::string::npos) break;
    const bool is_code = text[mark] == '`';
    const std::string opening = is_code ? "`" : "[[", closing = is_code ? "`" : "]]";
    const std::size_t begin = mark + opening.size();
    const std::size_t end = text.find(closing, begin);
    if (text.compare(mark, opening.size(), opening) != 0 || end == std::string::npos) {
      take(mark + 1);
      done = mark + 1;
      continue;
    }
    take(mark);
    const std::string inside = text.substr(begin, end - begin);
    result += is_code ? fmt::format("<code>{}</code>", escape(inside))
                      : fmt::format("<a href=\"#{}\">{}</a>", escape(inside),
                                    escape(numbering.label(inside)));
    done = end + closing.size();
  }
  take(text.size());
  return result;
}

std::string html_of(const Paragraph& paragraph, const Numbering& numbering) {
  return fmt::format("<p>{}</p>\n", inline_html(paragraph.text, numbering));
}

std::string html_of(const KeyValueList& list, const Numbering&) {
  std::string rows;
  for (const KeyValue& entry : list.entries)
    rows +=
        fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(entry.key), escape(entry.value));
  return fmt::format("<dl class=\"settings\">\n{}</dl>\n", rows);
}

std::string html_of(const KeyNumbers& numbers, const Numbering&) {
  std::string tiles;
  for (const KeyValue& entry : numbers.entries)
    tiles +=
        fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(entry.key), escape(entry.value));
  return fmt::format("<dl class=\"key-numbers\">\n{}</dl>\n", tiles);
}

std::string html_of(const Table& table, const Numbering& numbering) {
  const auto cell = [&](const char* tag, std::size_t column, const std::string& content) {
    constexpr std::size_t max_unbroken = 60;  // what is longer is a sentence
    const char* kind = table.columns[column].numeric   ? " class=\"number\""
                       : content.size() > max_unbroken ? " class=\"long\""
                                                       : "";
    return fmt::format("<{}{}>{}</{}>", tag, kind, content, std::string_view(tag).substr(0, 2));
  };
  std::string header, rows;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    header += cell("th scope=\"col\"", c, inline_html(table.columns[c].header, numbering));
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    require(table.rows[r].size() == table.columns.size(), fmt::format("Table::rows[{}].size", r),
            table.rows[r].size(),
            fmt::format("must equal columns.size = {}", table.columns.size()));
    const bool is_highlighted = table.highlighted_row && std::cmp_equal(*table.highlighted_row, r);
    rows += is_highlighted ? "<tr class=\"highlighted\">" : "<tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      rows += cell(c == 0 ? "th scope=\"row\"" : "td", c, escape(table.rows[r][c]));
    rows += "</tr>\n";
  }
  const std::string id = table.id.empty() ? "" : fmt::format(" id=\"{}\"", escape(table.id));
  return fmt::format(
      "<div class=\"table\"{}>\n<table>\n<caption><span><b>{}.</b> {}</span></caption>\n"
      "<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n",
      id, numbering.label(table), inline_html(table.caption, numbering), header, rows);
}

std::string html_of(const CodeBlock& code, const Numbering&) {
  return fmt::format("<pre><code>{}</code></pre>\n", escape(code.text));
}

std::string html_of(const CheckedStatementList& list, const Numbering& numbering) {
  static constexpr std::array classes = {"holds", "in-part", "fails"};
  std::string items;
  for (const CheckedStatement& entry : list.entries) {
    const std::string why = entry.why.empty() ? ""
                                              : fmt::format("<p class=\"why\">{}</p>",
                                                            inline_html(entry.why, numbering));
    items += fmt::format(
        "<li class=\"{}\"><p class=\"verdict\">{}</p>\n<div><p class=\"statement\">{}</p>\n"
        "<p class=\"measured\">{}</p>{}</div></li>\n",
        classes[static_cast<std::size_t>(entry.verdict)], name_of(entry.verdict),
        inline_html(entry.statement, numbering), inline_html(entry.measured, numbering), why);
  }
  return fmt::format("<ul class=\"statements\">\n{}</ul>\n", items);
}

/// A path as a URL: what could end it or start a scheme is escaped.
std::string as_url(const std::string& path) {
  std::string url;
  for (const char c : path)
    url += is_letter_or_digit(c) || std::string_view("-._~/").find(c) != std::string_view::npos
               ? std::string(1, c)
               : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return url;
}

std::string html_of(const LinkList& list, const Numbering& numbering) {
  std::string items;
  for (const Link& link : list.entries)
    items += fmt::format("<li><a href=\"{}\">{}</a> {}</li>\n", as_url(link.path),
                         escape(link.text), inline_html(link.note, numbering));
  return fmt::format("<ul class=\"links\">\n{}</ul>\n", items);
}

std::string html_of(const Figure& figure, const Numbering& numbering) {
  const FigureText& text = figure.text();
  const FigureSize& size = figure.size();
  return fmt::format(
      "<figure id=\"{0}\">\n<div class=\"scroll\"><div class=\"plot\" role=\"img\" "
      "aria-label=\"{1}\" data-figure=\"{0}\" data-fixed=\"{2:.6g}\" data-per-width=\"{3:.6g}\" "
      "data-min-width=\"{4:.6g}\" style=\"min-height:{5:.0f}px\"></div></div>\n"
      "<noscript><p>{1}</p></noscript>\n"
      "<figcaption><b>{6}. {7}.</b> {8}</figcaption>\n</figure>\n",
      text.id, escape(text.alt_text.empty() ? text.title : text.alt_text), size.fixed_px,
      size.per_width, size.min_width_px, size.fixed_px + size.per_width * 320,
      numbering.label(text.id), escape(text.title), inline_html(text.caption, numbering));
}

}  // namespace

Numbering::Numbering(const Page& page) {
  int figures = 0, tables = 0;
  const auto add = [&](const std::string& id, const std::string& label) {
    require(labels_.emplace(id, label).second, "id", id, "must be used once on a page");
  };
  for (const Section& section : page.sections) {
    for (const Block& block : section.blocks) {
      if (const auto* figure = std::get_if<Figure>(&block)) {
        add(figure->text().id, fmt::format("Figure {}", ++figures));
      } else if (const auto* table = std::get_if<Table>(&block)) {
        table_labels_[table] = fmt::format("Table {}", ++tables);
        if (!table->id.empty()) add(table->id, table_labels_[table]);
      }
    }
  }
}

const std::string& Numbering::label(const std::string& id) const {
  const auto found = labels_.find(id);
  require(found != labels_.end(), "[[id]]", id, "must be a figure or table of the page");
  return found->second;
}

const std::string& Numbering::label(const Table& table) const { return table_labels_.at(&table); }

std::string html(const Block& block, const Numbering& numbering) {
  return std::visit([&](const auto& one) { return html_of(one, numbering); }, block);
}

}  // namespace tofsmith::page_blocks

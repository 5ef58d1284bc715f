// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/page.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <span>

#include "report/html.hpp"
#include "report/packed_arrays.hpp"
#include "report/page_blocks.hpp"
#include "report/resources.hpp"

namespace tofsmith {
namespace {

using html::escape;

/// What a browser may do with the page: run what is in it and load nothing. plotly.js compiles
/// its 3D drawing code with `new Function`, hence unsafe-eval.
constexpr std::string_view content_policy =
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'";

std::string head(const Page& page) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta name=\"generator\" content=\"tofsmith\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n",
      content_policy, escape(page.title), resources::page_css());
}

std::string section_id(std::size_t index) { return fmt::format("section-{}", index + 1); }

std::string contents(const Page& page) {
  std::string list;
  for (std::size_t i = 0; i < page.sections.size(); ++i)
    list += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section_id(i),
                        escape(page.sections[i].title));
  return fmt::format(
      "<nav class=\"contents\" aria-label=\"Contents\">\n<details open>\n"
      "<summary>Contents</summary>\n<ol>\n{}</ol>\n</details>\n</nav>\n",
      list);
}

std::string masthead(const Page& page) {
  std::string subtitle;
  if (!page.subtitle.empty())
    subtitle = fmt::format("<p class=\"subtitle\">{}</p>\n", escape(page.subtitle));
  return fmt::format("<header>\n<h1>{}</h1>\n{}</header>\n", escape(page.title), subtitle);
}

std::string data_element(std::string_view id, std::string_view json) {
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id,
                     html::escape_json_for_script(json));
}

/// The figures' JSON and the scripts, last: text can be read while they load. A page without
/// figures needs none.
std::string scripts(const Page& page) {
  std::string elements;
  plotly::PackedArrays arrays;
  for (const Section& section : page.sections)
    for (const Block& block : section.blocks)
      if (const auto* figure = std::get_if<Figure>(&block)) {
        auto json = plotly::Json::parse(figure->plotly_json());
        arrays.take_from(json);
        elements += data_element("data-" + figure->text().id, json.dump());
      }
  if (elements.empty()) return "";
  const std::string_view plotly_js = resources::plotly_js();
  const std::span packed(reinterpret_cast<const std::uint8_t*>(plotly_js.data()), plotly_js.size());
  return fmt::format(
      "{}{}<script type=\"application/gzip\" id=\"plotly-js\">{}</script>\n"
      "<script>\n{}{}</script>\n",
      elements, data_element("packed-arrays", arrays.json().dump()), plotly::encode_base64(packed),
      resources::plotly_licences(), resources::page_js());
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  static constexpr std::array<std::string_view, 3> names = {"holds", "holds in part",
                                                            "does not hold"};
  return names[static_cast<std::size_t>(verdict)];
}

std::string render(const Page& page) {
  const page_blocks::Numbering numbering(page);
  std::string body;
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    body += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n"
        "<h2 id=\"{0}-title\">{1}</h2>\n",
        section_id(i), escape(page.sections[i].title));
    for (const Block& block : page.sections[i].blocks) body += page_blocks::html(block, numbering);
    body += "</section>\n";
  }
  std::string footer;
  if (!page.footer.empty()) footer = fmt::format("<footer>{}</footer>\n", escape(page.footer));
  return fmt::format(
      "{}<body>\n<div class=\"page\">\n{}<main>\n{}{}{}</main>\n</div>\n{}</body>\n"
      "</html>\n",
      head(page), contents(page), masthead(page), body, footer, scripts(page));
}

}  // namespace tofsmith

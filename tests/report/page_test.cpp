// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <zlib.h>

#include <cstdint>
#include <set>

#include "report/plotly_json.hpp"
#include "report/resources.hpp"
#include "sample_page.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::Not;

/// plotly.js as it stands in a page.
std::string packed_plotly() {
  const std::string_view bytes = resources::plotly_js();
  return plotly::encode_base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::string without_plotly(std::string page) {
  const std::string plotly = packed_plotly();
  const auto at = page.find(plotly);
  return at == std::string::npos ? page : page.erase(at, plotly.size());
}

/// A page with these blocks, without the embedded plotly.js.
std::string render_blocks(std::vector<Block> blocks) {
  return without_plotly(render({.title = "Page", .sections = {{"Section", std::move(blocks)}}}));
}

/// What zlib makes of bytes, zlib's own or gzip's.
std::string inflated(std::string_view bytes, std::size_t largest) {
  std::string out(largest, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 32), Z_OK);  // either header
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

Figure some_figure(const std::string& id, const std::string& name = "series") {
  return line_figure({id, "Title of " + id, "Caption of " + id},
                     {{.name = name, .x = {1}, .y = {1}}}, {}, {});
}

int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST(Page, HasTheSameBytesEveryTime) {
  EXPECT_TRUE(render(sample_page()) == render(sample_page()));
}

TEST(Page, ShowsMarkupInTextAsText) {
  const std::string evil = "<img src=x onerror=\"alert('&')\">";
  const std::string shown = "&lt;img src=x onerror=&quot;alert(&#39;&amp;&#39;)&quot;&gt;";
  const std::string page = render_blocks(
      {Paragraph{evil}, Paragraph{"`" + evil + "`"}, CodeBlock{evil}, KeyValueList{{{evil, evil}}},
       KeyNumbers{{{evil, evil}}}, Table{.caption = evil, .columns = {{evil}}, .rows = {{evil}}},
       line_figure({"id", evil, evil, evil}, {{.name = evil, .x = {1}, .y = {1}}}, {}, {})});
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_EQ(count(page, shown), 14);
}

TEST(Page, KeepsScriptElementsWholeWhateverTheNames) {
  const std::string page = render_blocks({some_figure("id", "</script><script>alert(1)//<!--")});
  EXPECT_EQ(count(page, "<script"), 4);
  EXPECT_EQ(count(page, "</script"), 4);
  EXPECT_THAT(page, Not(HasSubstr("<!--")));
}

TEST(Page, EmbedsPlotlyWithItsLicencesAndWithoutEndingItsScript) {
  const std::string licences(resources::plotly_licences());
  for (const char* words : {"Copyright 2012-2021 Plotly, Inc.", "Mike Bostock",
                            "this permission notice shall be included",
                            "Redistributions in binary form must reproduce"})
    EXPECT_THAT(licences, HasSubstr(words));
  EXPECT_EQ(count(licences, "</script"), 0);
  EXPECT_EQ(count(licences, "<!--"), 0);
  EXPECT_THAT(inflated(resources::plotly_js(), 8 << 20),
              HasSubstr("Licensed under the MIT license"));
  const std::string page = render(sample_page());
  EXPECT_THAT(page, HasSubstr(licences));
  EXPECT_THAT(page, HasSubstr(packed_plotly()));
}

TEST(Page, NamesNoPlaceOnTheNetwork) {
  const std::string page = without_plotly(render(sample_page()));
  EXPECT_EQ(count(page, "http://"), 0);
  EXPECT_EQ(count(page, "https://"), 0);
  EXPECT_EQ(count(page, " src="), 0);
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));  // and plotly.js may load nothing either
}

TEST(Page, HasNoIdTwice) {
  const std::string body = without_plotly(render(sample_page()));
  std::set<std::string> ids;
  for (auto at = body.find(" id=\""); at != std::string::npos; at = body.find(" id=\"", at + 1)) {
    const std::string id = body.substr(at + 5, body.find('"', at + 5) - at - 5);
    EXPECT_TRUE(ids.insert(id).second) << id;
  }
  EXPECT_GT(ids.size(), 20u);
}

TEST(Page, NumbersFiguresAndTablesInOrderAndLinksToThem) {
  const std::string page = render_blocks(
      {Paragraph{"See [[second]] and [[numbers]], not [these] or [[this."}, some_figure("first"),
       some_figure("second"), Table{.id = "numbers", .columns = {{"a"}}}});
  EXPECT_THAT(page,
              HasSubstr("<a href=\"#second\">Figure 2</a> and <a href=\"#numbers\">Table 1</a>"
                        ", not [these] or [[this."));
  EXPECT_THAT(page, HasSubstr("<b>Figure 1. Title of first.</b> Caption of first"));
  EXPECT_THAT(page, HasSubstr("<b>Figure 2. Title of second.</b>"));
}

TEST(Page, RefusesWhatDoesNotFit) {
  EXPECT_THROW(render_blocks({some_figure("a"), some_figure("a")}), std::invalid_argument);
  EXPECT_THROW(render_blocks({some_figure("a"), Table{.id = "a"}}), std::invalid_argument);
  EXPECT_THROW(render_blocks({Paragraph{"[[nothing]]"}}), std::invalid_argument);
  EXPECT_THROW(render_blocks({Table{.columns = {{"a"}, {"b"}}, .rows = {{"1", "2"}, {"1"}}}}),
               std::invalid_argument);
}

TEST(Page, WithoutFiguresHoldsNoScript) {
  const std::string page = render({.title = "t", .sections = {{"s", {Paragraph{"words"}}}}});
  EXPECT_EQ(count(page, "<script"), 0);
}

TEST(Page, SaysEveryVerdictInWords) {
  const std::string page =
      render_blocks({CheckedStatementList{{{Verdict::holds, "a < b", "1 `x`", ""},
                                           {Verdict::in_part, "second", "2", "because"},
                                           {Verdict::fails, "third", "3", ""}}}});
  EXPECT_THAT(page, HasSubstr("<li class=\"holds\"><p class=\"verdict\">holds</p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"statement\">a &lt; b</p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"measured\">1 <code>x</code></p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"verdict\">holds in part</p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"verdict\">does not hold</p>"));
  EXPECT_EQ(count(page, "<p class=\"why\">because</p>"), 1);
}

TEST(Page, LinksStayRelativeWhateverTheyAreCalled) {
  const std::string page =
      render_blocks({LinkList{{{"a & b", "javascript:alert(1)/\"x\".html", "note"}}}});
  EXPECT_THAT(page, HasSubstr("<a href=\"javascript%3Aalert%281%29/%22x%22.html\">a &amp; b</a>"));
}

TEST(Page, StressesTheHighlightedRowAlone) {
  const Table table{.columns = {{"Code"}, {"Error", true}},
                    .rows = {{"a", "1"}, {"b", "2"}},
                    .highlighted_row = 1};
  const std::string page = render_blocks({table});
  EXPECT_THAT(
      page,
      HasSubstr(
          "<tr class=\"highlighted\"><th scope=\"row\">b</th><td class=\"number\">2</td></tr>"));
  EXPECT_EQ(count(page, "<tr class=\"highlighted\">"), 1);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "report/viewer.hpp"
#include "sample_page.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

Page page_of(std::vector<Block> blocks) {
  return {.title = "Page", .sections = {{"Section", std::move(blocks)}}};
}

json blocks_of(std::vector<Block> blocks) {
  return json::parse(page_document(page_of(std::move(blocks))))["sections"][0]["blocks"];
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

json embedded_document(const std::string& html) {
  const std::string mark = "id=\"document\">";
  const std::size_t begin = html.find(mark) + mark.size();
  return json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(Page, HasTheSameBytesEveryTime) {
  EXPECT_TRUE(render(sample_page()) == render(sample_page()));
}

TEST(Page, ContainsTheViewerAndTheDocument) {
  const Page page = sample_page();
  const std::string html = render(page);
  EXPECT_EQ(embedded_document(html), json::parse(page_document(page)));
  EXPECT_THAT(html, HasSubstr("<title>Codes for paper-10f0</title>"));
  EXPECT_LT(viewer_page().size(), 150'000u);
}

TEST(Page, EscapesNamesInElements) {
  const std::string evil = "</script><script>alert('&')//<!--";
  Page page = page_of({Paragraph{evil}, CodeBlock{evil}, KeyValueList{{{evil, evil}}},
                       Table{.caption = evil, .columns = {{evil}}, .rows = {{evil}}},
                       some_figure("id", evil)});
  page.title = page.subtitle = page.footer = evil;
  const std::string html = render(page), empty = render({.title = "x"});
  for (const char* word : {"<script", "</script", "<!--"})
    EXPECT_EQ(count(html, word), count(empty, word)) << word;
  EXPECT_THAT(html, HasSubstr("<title>&lt;/script>&lt;script>alert('&amp;')"));
  EXPECT_EQ(embedded_document(html)["title"], evil);
}

TEST(Page, ReferencesNothingOnTheNetwork) {
  std::string html = render(sample_page());
  for (const char* space : {"http://www.w3.org/2000/svg"})  // a name, not an address
    for (auto at = html.find(space); at != std::string::npos; at = html.find(space))
      html.erase(at, std::string(space).size());
  EXPECT_EQ(count(html, "http://"), 0);
  EXPECT_EQ(count(html, "https://"), 0);
  EXPECT_EQ(count(html, " src="), 0);
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("unsafe-eval")));
}

TEST(Page, HasBlocksOfEveryKind) {
  const json blocks =
      blocks_of({Paragraph{"words"}, KeyValueList{{{"a", "b"}}}, KeyNumbers{{{"c", "d"}}},
                 Table{.id = "t",
                       .title = "T",
                       .columns = {{"h", true}},
                       .rows = {{"1"}},
                       .highlighted_row = 0},
                 CodeBlock{"run"}, some_figure("first")});
  std::vector<std::string> kinds;
  for (const json& block : blocks) kinds.push_back(block["kind"]);
  EXPECT_THAT(kinds, testing::ElementsAre("text", "settings", "numbers", "table", "code", "lines"));
  EXPECT_EQ(blocks[1]["entries"], json::parse(R"([["a", "b"]])"));
  EXPECT_EQ(blocks[3]["highlighted"], 0);
  EXPECT_EQ(blocks[3]["columns"], json::parse(R"([{"header": "h", "numeric": true}])"));
  EXPECT_EQ(blocks[5]["title"], "Title of first");
}

TEST(Page, SupportsOpenFoldedAndFrontSections) {
  const json sections =
      json::parse(page_document({.title = "t",
                                 .sections = {{"a", {}, SectionLayout::front},
                                              {"b", {}},
                                              {"c", {}, SectionLayout::folded}}}))["sections"];
  EXPECT_EQ(sections[0]["layout"], "front");
  EXPECT_EQ(sections[1]["layout"], "open");
  EXPECT_EQ(sections[2]["layout"], "folded");
}

TEST(Page, RejectsRepeatedIdsAndRowsOfOtherLengths) {
  EXPECT_THROW(blocks_of({some_figure("a"), some_figure("a")}), std::invalid_argument);
  EXPECT_THROW(blocks_of({some_figure("a"), Table{.id = "a"}}), std::invalid_argument);
  EXPECT_THROW(blocks_of({Table{.columns = {{"a"}, {"b"}}, .rows = {{"1", "2"}, {"1"}}}}),
               std::invalid_argument);
}

TEST(Page, ReplacesBytesThatAreNotUtf8) {
  const std::string document =
      page_document(page_of({Paragraph{"a\xff"
                                       "b"}}));
  EXPECT_TRUE(json::accept(document));
  EXPECT_NE(document.find("a\ufffdb"), std::string::npos);
}

}  // namespace
}  // namespace tofsmith

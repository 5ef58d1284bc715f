// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Folders are floors: a folder includes only what stands on a floor below it.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace tofsmith::house {
namespace {

using Folders = std::set<std::string>;

Folders operator+(Folders a, const Folders& b) {
  a.insert(b.begin(), b.end());
  return a;
}

const Folders data_types = {"core", "code", "scene", "camera", "decode", "simulate", "design"};
const Folders products = data_types + Folders{"io", "sweep", "calibrate", "instrument", "report"};
const Folders all = products + Folders{"reproduce"};

/// The house: which other folders each folder may include. simulate never includes design: the
/// judge does not know the candidate's maker.
const std::map<std::string, Folders> may_include = {
    {"core", {}},
    {"code", {"core"}},
    {"scene", {"core"}},
    {"camera", {"core", "code"}},
    {"decode", {"core", "code", "camera"}},
    {"simulate", {"core", "code", "scene", "camera", "decode"}},
    {"design", {"core", "code", "scene", "camera", "decode", "simulate"}},
    {"io", data_types},
    {"sweep", data_types + Folders{"io"}},
    {"calibrate", data_types + Folders{"io"}},
    {"instrument", data_types + Folders{"io"}},
    {"report", data_types + Folders{"io", "calibrate"}},
    {"reproduce", products},
    {"apps", all},
};

/// The folder a file lives in: "include/tofsmith/core/x.hpp", "src/core/x.cpp", "apps/x.cpp". A
/// file directly in include/tofsmith/ gathers others for the user and stands where apps stand.
std::string folder_of(const std::string& path) {
  std::smatch match;
  if (std::regex_match(path, match, std::regex("(?:include/tofsmith|src)/([^/]+)/.*")))
    return match[1];
  return "apps";
}

/// The folder an include line asks for; "" when the line is no include of ours. Ours are
/// "tofsmith/<folder>/x.hpp" and the private "<folder>/x.hpp".
std::string included_folder(const std::string& line) {
  static const std::regex include("\\s*#\\s*include\\s*[\"<](tofsmith/)?([^/\">]+)/[^\">]*[\">].*");
  std::smatch match;
  if (!std::regex_match(line, match, include)) return "";
  const bool is_public = match[1].matched;
  return is_public || match[2] == ".." || may_include.contains(match[2]) ? match.str(2) : "";
}

std::vector<std::string> upward_includes(const SourceFile& file) {
  const std::string here = folder_of(file.path);
  if (!may_include.contains(here))
    return {violation(file, 0, here + "/ stands on no floor; give it one in floors_test.cpp")};
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string there = included_folder(file.lines[i]);
    if (there.empty() || there == here || may_include.at(here).contains(there)) continue;
    std::string rule = here + "/ includes " + there + "/; it may include only";
    for (const std::string& folder : may_include.at(here)) rule += " " + folder;
    if (may_include.at(here).empty()) rule += " itself";
    found.push_back(violation(file, i, rule));
  }
  return found;
}

TEST(Floors, NoFileIncludesUpwards) {
  const std::vector<SourceFile> files = read_sources({"include", "src", "apps"});
  ASSERT_GT(files.size(), 10u);
  EXPECT_EQ(violations_in(files, upward_includes), "");
}

TEST(Floors, NoTwoFoldersMayIncludeEachOther) {
  for (const auto& [folder, below] : may_include)
    for (const std::string& other : below)
      EXPECT_FALSE(may_include.at(other).contains(folder)) << folder << " and " << other;
}

struct Example {
  const char* path;
  const char* line;
  bool allowed;
};

const Example examples[] = {
    {"src/core/x.cpp", "#include \"tofsmith/core/x.hpp\"", true},
    {"src/core/x.cpp", "#include \"tofsmith/version.hpp\"", true},
    {"src/core/x.cpp", "#include <vector>", true},
    {"src/core/x.cpp", "#include <hwy/highway.h>", true},
    {"src/core/x.cpp", "// #include \"tofsmith/io/x.hpp\"", true},
    {"src/io/x.cpp", "#include \"io/shared/byte_order.hpp\"", true},
    {"src/design/x.cpp", "#include \"tofsmith/simulate/bounds.hpp\"", true},
    {"src/report/x.cpp", "#include \"tofsmith/io/x.hpp\"", true},
    {"apps/x.cpp", "#include \"tofsmith/report/page.hpp\"", true},
    {"apps/x.cpp", "#include \"command.hpp\"", true},
    {"include/tofsmith/tofsmith.hpp", "#include \"tofsmith/io/x.hpp\"", true},
    {"include/tofsmith/core/x.hpp", "#include \"tofsmith/code/x.hpp\"", false},
    {"src/code/x.cpp", "#include \"tofsmith/scene/x.hpp\"", false},
    {"src/decode/x.cpp", "  #  include <tofsmith/io/x.hpp>", false},
    {"src/simulate/x.cpp", "#include \"tofsmith/design/x.hpp\"", false},
    {"src/simulate/x.cpp", "#include \"design/private.hpp\"", false},
    {"src/io/x.cpp", "#include \"tofsmith/report/x.hpp\"", false},
    {"src/report/x.cpp", "#include \"apps/x.hpp\"", false},
    {"src/core/x.cpp", "#include \"../io/x.hpp\"", false},
    {"src/core/x.cpp", "#include \"tofsmith/cellar/x.hpp\"", false},
    {"src/cellar/x.cpp", "#include <vector>", false},
};

TEST(Floors, ExamplesAreJudgedAsTheHouseSays) {
  for (const Example& example : examples) {
    SCOPED_TRACE(std::string(example.path) + " says " + example.line);
    const auto found = upward_includes({example.path, {"// first line", example.line}});
    EXPECT_EQ(found.empty(), example.allowed);
  }
}

TEST(Floors, AViolationNamesFileLineAndRule) {
  const SourceFile file{"src/code/x.cpp", {"", "#include \"tofsmith/io/x.hpp\""}};
  EXPECT_EQ(violations_in({file}, upward_includes),
            "src/code/x.cpp:2: code/ includes io/; it may include only core\n");
}

}  // namespace
}  // namespace tofsmith::house

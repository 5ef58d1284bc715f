// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Rules for every C++ file of the repository.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace tofsmith::house {
namespace {

constexpr std::size_t usual_file_lines = 350;  // longer files cause a warning
constexpr std::size_t max_file_lines = 500;
const std::vector<std::string> everywhere = {"include", "src",      "apps",      "python",
                                             "tests",   "examples", "benchmarks"};

std::vector<std::string> missing_licence(const SourceFile& file) {
  if (file.lines.size() >= 2 && file.lines[0].starts_with("// SPDX-FileCopyrightText: ") &&
      file.lines[1] == "// SPDX-License-Identifier: Apache-2.0")
    return {};
  return {violation(file, 0, "must start with the two SPDX lines")};
}

std::vector<std::string> longer_than(std::size_t lines, const SourceFile& file) {
  if (file.lines.size() <= lines) return {};
  return {violation(
      file, lines,
      "longer than " + std::to_string(lines) + " lines: usually two concepts in one file")};
}

std::vector<std::string> long_files(const SourceFile& file) {
  return longer_than(usual_file_lines, file);
}

std::vector<std::string> too_long(const SourceFile& file) {
  return longer_than(max_file_lines, file);
}

std::vector<std::string> printing_and_exiting(const SourceFile& file) {
  // A failed assertion has no caller that could handle it.
  if (file.path == "src/core/error.cpp") return {};
  static const std::regex forbidden(
      "std::(cout|cerr|clog)\\b|\\b(printf|fprintf|vprintf|puts|putchar)\\s*\\(|"
      "\\bfmt::print\\s*\\(|\\b(exit|_exit|quick_exit|abort|terminate)\\s*\\(");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string code = file.lines[i].substr(0, file.lines[i].find("//"));
    if (std::regex_search(code, forbidden))
      found.push_back(violation(file, i, "the library never prints and never exits"));
  }
  return found;
}

/// Kernels of equal names exist in several files, compiled with different options: everything in
/// HWY_NAMESPACE must be in an anonymous namespace.
std::vector<std::string> shared_kernels(const SourceFile& file) {
  const auto& lines = file.lines;
  const auto is_aside = [](const std::string& line) {
    return line.empty() || line.starts_with("//") || line.starts_with("namespace hn = ");
  };
  std::vector<std::string> found;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] == "namespace HWY_NAMESPACE {") {
      std::size_t next = i + 1;
      while (next < lines.size() && is_aside(lines[next])) ++next;
      if (next == lines.size() || lines[next] != "namespace {")
        found.push_back(violation(file, i, "must open an anonymous namespace at once"));
    }
    if (lines[i] == "}  // namespace HWY_NAMESPACE" &&
        (i == 0 || lines[i - 1] != "}  // namespace"))
      found.push_back(violation(file, i, "must close an anonymous namespace just before"));
  }
  return found;
}

std::set<std::string> types_defined_in(const SourceFile& file) {
  static const std::regex definition(
      R"((?:struct|class|union|enum(?: class)?) ([\w:]+)(?: final)?(?: : .*)? \{.*)");
  std::vector<std::string> spaces;
  std::set<std::string> types;
  for (const std::string& line : file.lines) {
    if (line.starts_with("namespace ") && line.ends_with("{"))
      spaces.push_back(line.substr(10, line.size() - 11));
    else if (line.starts_with("}  // namespace") && !spaces.empty())
      spaces.pop_back();
    const bool is_shared = std::ranges::find(spaces, "") == spaces.end();
    std::smatch match;
    if (!spaces.empty() && is_shared && std::regex_match(line, match, definition))
      types.insert(spaces.back() + match.str(1));
  }
  return types;
}

std::vector<std::string> types_defined_twice(const std::vector<SourceFile>& files) {
  std::map<std::string, std::string> home;
  std::vector<std::string> found;
  for (const SourceFile& file : files)
    for (const std::string& type : types_defined_in(file))
      if (const auto [entry, is_new] = home.try_emplace(type, file.path); !is_new)
        found.push_back(violation(file, 0, type + " is also defined in " + entry->second));
  return found;
}

std::vector<std::string> algorithms_of_ranges(const SourceFile& file) {
  static const std::regex forbidden(
      "std::(ranges|views)::|#\\s*include <ranges>|\\blexicographical_compare_three_way\\b");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i)
    if (std::regex_search(file.lines[i].substr(0, file.lines[i].find("//")), forbidden))
      found.push_back(violation(file, i, "Debian's emscripten has no std::ranges algorithms"));
  return found;
}

TEST(House, CoreAndDesignCompileWithDebiansEmscripten) {
  for (const char* floor : {"core", "code", "camera", "scene", "decode", "simulate", "design"})
    EXPECT_EQ(violations_in(read_sources({std::string("include/tofsmith/") + floor,
                                          std::string("src/") + floor}),
                            algorithms_of_ranges),
              "");
  EXPECT_EQ(violations_in(read_sources({"src/io/text", "src/io/documents", "apps/lab"}),
                          algorithms_of_ranges),
            "");
}

TEST(House, EveryFileHasALicence) {
  EXPECT_EQ(violations_in(read_sources(everywhere), missing_licence), "");
}

TEST(House, NoFileIsTooLong) {
  const std::vector<SourceFile> files = read_sources(everywhere);
  EXPECT_EQ(violations_in(files, too_long), "");
  const std::string warnings = violations_in(files, long_files);
  if (!warnings.empty()) std::cout << "warning, nothing is forbidden here:\n" << warnings;
}

TEST(House, TheLibraryNeverPrintsAndNeverExits) {
  EXPECT_EQ(violations_in(read_sources({"include", "src"}), printing_and_exiting), "");
}

TEST(House, KernelsAreLocalToTheirFile) {
  EXPECT_EQ(violations_in(read_sources({"src"}), shared_kernels), "");
}

TEST(House, EveryTypeHasOneDefinition) {
  const auto files = read_sources({"include", "src", "apps", "python"});
  EXPECT_THAT(types_defined_twice(files), testing::IsEmpty());
}

TEST(House, DetectsASecondDefinition) {
  const SourceFile first{"src/a.hpp", {"namespace tofsmith {", "struct Match {", "};"}};
  const SourceFile second{"src/b.hpp", {"namespace tofsmith {", "class Match : Base {", "};"}};
  const SourceFile hidden{"src/c.cpp", {"namespace tofsmith {", "namespace {", "struct Match {}"}};
  const SourceFile declared{"src/d.hpp", {"namespace tofsmith {", "struct Match;"}};
  const SourceFile elsewhere{"src/e.hpp", {"namespace tofsmith::apps {", "struct Match {"}};
  EXPECT_EQ(types_defined_twice({first, second}).size(), 1u);
  EXPECT_EQ(types_defined_twice({first, hidden, declared, elsewhere}).size(), 0u);
}

TEST(House, DetectsViolations) {
  const auto breaks = [](auto law, std::vector<std::string> lines) {
    return !law(SourceFile{"src/core/x.cpp", std::move(lines)}).empty();
  };
  const std::string copyright = "// SPDX-FileCopyrightText: 2026 The tofsmith authors";
  const std::string licence = "// SPDX-License-Identifier: Apache-2.0";
  EXPECT_FALSE(breaks(missing_licence, {copyright, licence, ""}));
  EXPECT_TRUE(breaks(missing_licence, {"", copyright, licence}));
  EXPECT_TRUE(breaks(missing_licence, {copyright}));
  EXPECT_TRUE(breaks(missing_licence, {}));

  EXPECT_TRUE(breaks(algorithms_of_ranges, {"std::ranges::sort(x);"}));
  EXPECT_FALSE(breaks(algorithms_of_ranges, {"std::sort(x.begin(), x.end());  // std::ranges::"}));

  EXPECT_FALSE(breaks(long_files, std::vector<std::string>(350)));
  EXPECT_TRUE(breaks(long_files, std::vector<std::string>(351)));
  EXPECT_FALSE(breaks(too_long, std::vector<std::string>(500)));
  EXPECT_TRUE(breaks(too_long, std::vector<std::string>(501)));

  const std::string opens = "namespace HWY_NAMESPACE {", closes = "}  // namespace HWY_NAMESPACE";
  EXPECT_FALSE(breaks(shared_kernels, {opens, "namespace hn = hwy::HWY_NAMESPACE;", "namespace {",
                                       "int f();", "}  // namespace", closes}));
  EXPECT_TRUE(
      breaks(shared_kernels, {opens, "int f();", "namespace {", "}  // namespace", closes}));
  EXPECT_TRUE(
      breaks(shared_kernels, {opens, "namespace {", "}  // namespace", "int f();", closes}));

  for (const char* line :
       {"std::cout << x;", "  std::cerr << x;", "printf(\"x\");", "std::fprintf(stderr, \"x\");",
        "fmt::print(\"x\");", "std::exit(1);", "  exit (1);", "std::abort();", "puts(\"x\");"})
    EXPECT_TRUE(breaks(printing_and_exiting, {line})) << line;
  for (const char* line :
       {"std::snprintf(text, 8, \"x\");", "fmt::format(\"x\");", "// printf(\"x\")", "on_exit(f);",
        "std::ostringstream text;", "print_size(3);"})
    EXPECT_FALSE(breaks(printing_and_exiting, {line})) << line;
}

}  // namespace
}  // namespace tofsmith::house

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What every C++ file of the house keeps to.
#include <gtest/gtest.h>

#include <iostream>
#include <regex>

#include "source_files.hpp"

namespace tofsmith::house {
namespace {

constexpr std::size_t usual_file_lines = 350;  // beyond, a file may be one large concept: a warning
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
  // The assertion on our own bugs has no caller to report to.
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

TEST(House, EveryFileNamesItsLicence) {
  EXPECT_EQ(violations_in(read_sources(everywhere), missing_licence), "");
}

TEST(House, NoFileIsTwoConceptsLong) {
  const std::vector<SourceFile> files = read_sources(everywhere);
  EXPECT_EQ(violations_in(files, too_long), "");
  const std::string warnings = violations_in(files, long_files);
  if (!warnings.empty()) std::cout << "warning, nothing is forbidden here:\n" << warnings;
}

TEST(House, TheLibraryNeverPrintsAndNeverExits) {
  EXPECT_EQ(violations_in(read_sources({"include", "src"}), printing_and_exiting), "");
}

TEST(House, LawsFindWhatBreaksThem) {
  const auto breaks = [](auto law, std::vector<std::string> lines) {
    return !law(SourceFile{"src/core/x.cpp", std::move(lines)}).empty();
  };
  const std::string copyright = "// SPDX-FileCopyrightText: 2026 The tofsmith authors";
  const std::string licence = "// SPDX-License-Identifier: Apache-2.0";
  EXPECT_FALSE(breaks(missing_licence, {copyright, licence, ""}));
  EXPECT_TRUE(breaks(missing_licence, {"", copyright, licence}));
  EXPECT_TRUE(breaks(missing_licence, {copyright}));
  EXPECT_TRUE(breaks(missing_licence, {}));

  EXPECT_FALSE(breaks(long_files, std::vector<std::string>(350)));
  EXPECT_TRUE(breaks(long_files, std::vector<std::string>(351)));
  EXPECT_FALSE(breaks(too_long, std::vector<std::string>(500)));
  EXPECT_TRUE(breaks(too_long, std::vector<std::string>(501)));

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Folders are layers: a folder includes only folders of lower layers. Subfolders of a layer (rooms)
// must not depend on each other cyclically. A private header may only be included within its layer,
// unless it is in shared/. Layers form components.
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
const Folders products =
    data_types + Folders{"gpu", "io", "report", "waveforms", "sweep", "calibrate"};

/// Other folders that each folder may include. simulate never includes design, because the
/// evaluation must not depend on the origin of a candidate.
const std::map<std::string, Folders> may_include = {
    {"core", {}},
    {"code", {"core"}},
    {"scene", {"core"}},
    {"camera", {"core", "code"}},
    {"decode", {"core", "code", "camera"}},
    {"simulate", {"core", "code", "scene", "camera", "decode"}},
    {"gpu", {"core", "code", "scene", "camera", "decode"}},
    {"design", {"core", "code", "scene", "camera", "decode", "simulate"}},
    {"io", data_types},
    {"sweep", data_types + Folders{"io"}},
    {"report", data_types + Folders{"io"}},
    {"waveforms", data_types + Folders{"io", "report"}},
    {"calibrate", data_types + Folders{"io", "report"}},
    {"apps", products},
};

/// A component with its folders and the component that it depends on, as in
/// cmake/TofsmithComponents.cmake.
struct Component {
  Folders folders;
  std::string below;
};
const std::map<std::string, Component> components = {
    {"core", {{"core", "code", "scene", "camera", "decode", "simulate"}, ""}},
    {"gpu", {{"gpu"}, "core"}},
    {"design", {{"design"}, "core"}},
    {"io", {{"io"}, "design"}},
    {"report", {{"report"}, "io"}},
    {"lab", {{"waveforms", "calibrate"}, "report"}},
    {"sweep", {{"sweep"}, "io"}},
};

/// Returns the folder of a file: "include/tofsmith/core/x.hpp", "src/core/x.cpp", "apps/x.cpp".
/// Files directly in include/tofsmith/ are umbrella headers and belong to the layer of apps.
std::string folder_of(const std::string& path) {
  std::smatch match;
  if (std::regex_match(path, match, std::regex("(?:include/tofsmith|src)/([^/]+)/.*")))
    return match[1];
  return "apps";
}

/// Returns the folder that an include line refers to, or "" for other lines. Considered are
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
    return {violation(file, 0, here + "/ belongs to no layer; add it to floors_test.cpp")};
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

TEST(Floors, AComponentIncludesOnlyItselfAndItsDependencies) {
  for (const auto& [name, component] : components) {
    Folders within = component.folders;
    for (std::string below = component.below; !below.empty(); below = components.at(below).below)
      within = within + components.at(below).folders;
    for (const std::string& folder : component.folders)
      for (const std::string& other : may_include.at(folder))
        EXPECT_TRUE(within.contains(other)) << name << ": " << folder << " and " << other;
  }
}

/// Location of a private header: "src/decode/search/shared/x.hpp" is in layer "decode", room
/// "search", shared. Files directly in a layer are in room "".
struct Place {
  std::string floor, room;
  bool is_shared = false;
};

Place place_of(const std::string& private_path) {
  static const std::regex parts("([^/]+)/(?:([^/]+)/)?(?:([^/]+)/)?[^/]+");
  std::smatch match;
  if (!std::regex_match(private_path, match, parts)) return {};
  Place place{match[1], match[2], false};
  if (place.room == "shared") return {match[1], "", true};
  place.is_shared = match[3] == "shared";
  return place;
}

/// Returns the path below src/ of the private header that a line includes, or "".
std::string private_include(const std::string& line) {
  static const std::regex include("\\s*#\\s*include\\s*\"([^\"]+)\".*");
  std::smatch match;
  if (!std::regex_match(line, match, include)) return "";
  const std::string path = match[1];
  const std::string folder = path.substr(0, path.find('/'));
  return folder != path && folder != "apps" && may_include.contains(folder) ? path : "";
}

std::vector<std::string> borrowed_headers(const SourceFile& file) {
  const std::string here = folder_of(file.path);
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string header = private_include(file.lines[i]);
    if (header.empty()) continue;
    const Place there = place_of(header);
    if (file.path.starts_with("include/"))
      found.push_back(violation(file, i, "a public header includes public ones only"));
    else if (here == "apps" && !file.path.starts_with("apps/lab/engine/"))
      found.push_back(violation(file, i, "what users build upon is public: " + header));
    else if (there.floor != here && !there.is_shared)
      found.push_back(
          violation(file, i, header + " is " + there.floor + "/'s own: not in shared/"));
  }
  return found;
}

TEST(Rooms, APrivateHeaderIsUsedWithinItsLayerUnlessItIsShared) {
  const auto files = read_sources({"include", "src", "apps", "python", "examples"});
  EXPECT_EQ(violations_in(files, borrowed_headers), "");
}

TEST(Rooms, SharedHeadersAreUsedByAnotherLayer) {
  const std::vector<SourceFile> files = read_sources({"src"});
  Folders borrowed;
  for (const SourceFile& file : files)
    for (const std::string& line : file.lines) {
      const std::string header = private_include(line);
      if (!header.empty() && place_of(header).floor != folder_of(file.path))
        borrowed.insert("src/" + header);
    }
  for (const SourceFile& file : files)
    if (file.path.find("/shared/") != std::string::npos) {
      EXPECT_TRUE(borrowed.contains(file.path))
          << file.path << " is shared, but only its own folder uses it";
    }
}

TEST(Rooms, SubfoldersHaveNoCyclicDependencies) {
  std::map<std::string, Folders> includes;  // by "floor/room"
  std::string from_ground;
  for (const SourceFile& file : read_sources({"src"})) {
    const Place here = place_of(file.path.substr(4));
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::string header = private_include(file.lines[i]);
      const Place there = place_of(header);
      if (header.empty() || there.floor != here.floor || there.room == here.room) continue;
      if (!here.room.empty() && !there.room.empty())
        includes[here.floor + "/" + here.room].insert(there.floor + "/" + there.room);
      // Rooms may depend on headers of room ""; its sources may depend on all rooms.
      if (here.room.empty() && file.path.ends_with(".hpp"))
        from_ground += violation(file, i, "the ground includes a room: " + header) + '\n';
    }
  }
  EXPECT_EQ(from_ground, "");
  // Repeatedly removes rooms that include only removed ones; a cycle remains.
  for (bool any = true; any;) {
    any = false;
    for (auto it = includes.begin(); it != includes.end();) {
      std::erase_if(it->second, [&](const std::string& room) { return !includes.contains(room); });
      any = any || it->second.empty();
      it = it->second.empty() ? includes.erase(it) : std::next(it);
    }
  }
  std::string circle;
  for (const auto& [room, others] : includes)
    for (const std::string& other : others) circle += room + " includes " + other + '\n';
  EXPECT_EQ(circle, "");
}

TEST(PublicHeaders, EachUmbrellaHeaderIncludesThoseOfItsComponent) {
  std::map<std::string, Folders> of_folder;
  std::map<std::string, std::string> umbrellas;
  for (const SourceFile& file : read_sources({"include"})) {
    const std::string name = file.path.substr(std::string("include/").size());
    if (folder_of(file.path) == "apps")
      for (const std::string& line : file.lines) umbrellas[name] += line + '\n';
    else
      of_folder[folder_of(file.path)].insert(name);
  }
  for (const auto& [name, component] : components) {
    const std::string umbrella = umbrellas["tofsmith/" + name + ".hpp"];
    const std::string below = component.below;
    if (!below.empty()) {
      EXPECT_NE(umbrella.find("tofsmith/" + below + ".hpp"), std::string::npos);
    }
    for (const std::string& folder : component.folders)
      for (const std::string& header : of_folder[folder])
        EXPECT_NE(umbrella.find('"' + header + '"'), std::string::npos) << name << ": " << header;
    EXPECT_NE(umbrellas["tofsmith/tofsmith.hpp"].find("\"tofsmith/" + name + ".hpp\""),
              std::string::npos);
  }
}

struct Example {
  const char* path;
  const char* line;
  bool allowed;
};

const Example examples[] = {
    {"src/core/x.cpp", "#include \"tofsmith/core/x.hpp\"", true},
    {"src/core/x.cpp", "#include \"tofsmith/version.hpp\"", true},
    {"src/core/x.cpp", "#include <hwy/highway.h>", true},
    {"src/core/x.cpp", "// #include \"tofsmith/io/x.hpp\"", true},
    {"src/design/x.cpp", "#include \"tofsmith/simulate/bounds.hpp\"", true},
    {"src/decode/search/x.cpp", "#include \"core/shared/x.hpp\"", true},
    {"src/decode/search/x.cpp", "#include \"simulate/shared/x.hpp\"", false},
    {"apps/x.cpp", "#include \"tofsmith/report/page.hpp\"", true},
    {"apps/x.cpp", "#include \"command.hpp\"", true},
    {"include/tofsmith/tofsmith.hpp", "#include \"tofsmith/io/x.hpp\"", true},
    {"include/tofsmith/core/x.hpp", "#include \"tofsmith/code/x.hpp\"", false},
    {"src/code/x.cpp", "#include \"tofsmith/scene/x.hpp\"", false},
    {"src/decode/x.cpp", "  #  include <tofsmith/io/x.hpp>", false},
    {"src/simulate/x.cpp", "#include \"design/private.hpp\"", false},
    {"src/report/x.cpp", "#include \"apps/x.hpp\"", false},
    {"src/core/x.cpp", "#include \"../io/x.hpp\"", false},
    {"src/core/x.cpp", "#include \"tofsmith/cellar/x.hpp\"", false},
    {"src/cellar/x.cpp", "#include <vector>", false},
};

TEST(Floors, DetectsViolationsInExamples) {
  for (const Example& example : examples) {
    SCOPED_TRACE(std::string(example.path) + " says " + example.line);
    const auto found = upward_includes({example.path, {"// first line", example.line}});
    EXPECT_EQ(found.empty(), example.allowed);
  }
}

TEST(Rooms, DetectsViolationsInExamples) {
  const auto borrows = [](const char* path, const char* line) {
    return !borrowed_headers({path, {line}}).empty();
  };
  EXPECT_FALSE(borrows("src/decode/x.cpp", "#include \"decode/search/x.hpp\""));
  EXPECT_FALSE(borrows("src/simulate/x.cpp", "#include \"decode/search/shared/x.hpp\""));
  EXPECT_FALSE(borrows("src/simulate/x.cpp", "#include \"core/shared/x.hpp\""));
  EXPECT_FALSE(borrows("apps/x.cpp", "#include \"session.hpp\""));
  EXPECT_TRUE(borrows("src/simulate/x.cpp", "#include \"decode/search/x.hpp\""));
  EXPECT_TRUE(borrows("src/simulate/x.cpp", "#include \"core/x.hpp\""));
  EXPECT_TRUE(borrows("apps/x.cpp", "#include \"io/shared/x.hpp\""));
  EXPECT_FALSE(borrows("apps/lab/engine/x.cpp", "#include \"io/shared/x.hpp\""));
  EXPECT_TRUE(borrows("apps/lab/engine/x.cpp", "#include \"io/x.hpp\""));
  EXPECT_TRUE(borrows("include/tofsmith/core/x.hpp", "#include \"core/shared/x.hpp\""));
}

TEST(Floors, AViolationReportsFileLineAndRule) {
  const SourceFile file{"src/code/x.cpp", {"", "#include \"tofsmith/io/x.hpp\""}};
  EXPECT_EQ(violations_in({file}, upward_includes),
            "src/code/x.cpp:2: code/ includes io/; it may include only core\n");
}

}  // namespace
}  // namespace tofsmith::house

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "python_module.hpp"
#include "session.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

namespace fs = std::filesystem;

/// Returns the page of the installation or, in a build tree, that of scripts/lab.sh.
/// @throws IoError that explains how to build it
fs::path lab_page() {
  const fs::path here = program_directory();
  const std::array places = {here / "../share/tofsmith/lab.html",
                             here / "../../build-lab/lab.html"};
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored)) return place;
  }
  throw IoError(places.front().lexically_normal().string(),
                "does not exist, because this tofsmith was built without the lab page; build it in "
                "the source tree with scripts/lab.sh -o lab.html");
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file || content.empty()) throw IoError(path.string(), "cannot be read");
  return content;
}

void run(const std::string& output, const Session& session) {
  session.check_output(output);
  const std::string content = content_of(lab_page());
  write_file_atomically(output, content, session.output_policy());
  session.print_json({{"output", output}, {"bytes", content.size()}});
  session.say(fmt::format("wrote {}; open it in a browser (no network required)", output));
}

}  // namespace

void add_lab_command(CLI::App& app, Session& session) {
  auto output = std::make_shared<std::string>("lab.html");
  CLI::App* command = app.add_subcommand(
      "lab", "write the lab, an interactive web page for exploring cameras and codes");
  command->add_option("-o,--output", *output, "HTML file")->capture_default_str();
  command->callback([output, &session] { run(*output, session); });
}

}  // namespace tofsmith::apps

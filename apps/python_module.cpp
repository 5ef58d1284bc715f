// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "python_module.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

namespace fs = std::filesystem;

constexpr const char* debian_python = "/usr/bin/python3";

/// Runs the module named by the first argument with the remaining arguments.
constexpr const char* bootstrap =
    "import importlib.util, runpy, sys\n"
    "if importlib.util.find_spec('tofsmith') is None:\n"
    "    sys.exit(f'tofsmith: {sys.executable} cannot find the package tofsmith, which this "
    "command requires; '\n"
    "             'on Debian: apt install python3-tofsmith')\n"
    "try:\n"
    "    runpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)\n"
    "except KeyboardInterrupt:\n"
    "    sys.stderr.write('tofsmith: interrupted\\n')\n"
    "    sys.exit(130)\n";

std::string interpreter() {
  if (const char* const chosen = std::getenv("TOFSMITH_PYTHON"); chosen != nullptr) return chosen;
  return fs::exists(debian_python) ? debian_python : "python3";
}

/// Adds the package that belongs to this program to the search path of Python.
void add_package_to_path() {
  const fs::path here = program_directory();
  const std::array places = {here / "../python", here / "../lib/python3/dist-packages",
                             here / "../../.."};
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (!fs::exists(place / "tofsmith/__init__.py", ignored)) continue;
    std::string path = place.lexically_normal().string();
    if (const char* const others = std::getenv("PYTHONPATH"); others != nullptr)
      path += std::string(":") + others;
    ::setenv("PYTHONPATH", path.c_str(), 1);
    return;
  }
}

[[noreturn]] void fail(std::string_view place, std::string_view problem) {
  throw IoError(place, std::string(problem) + " (" + std::generic_category().message(errno) + ")");
}

void use_as_standard_input(const std::string& input) {
  std::FILE* const file = std::tmpfile();
  if (file == nullptr) fail("temporary file", "cannot be created");
  if (std::fwrite(input.data(), 1, input.size(), file) != input.size() ||
      std::fseek(file, 0, SEEK_SET) != 0)
    fail("temporary file", "cannot be written");
  if (::dup2(::fileno(file), STDIN_FILENO) < 0) fail("standard input", "cannot be replaced");
}

}  // namespace

void run_python_module(const std::string& module, const std::string& input,
                       const std::vector<std::string>& arguments) {
  add_package_to_path();
  if (!input.empty()) use_as_standard_input(input);
  std::fflush(stdout);
  const std::string python = interpreter();
  std::vector<std::string> words = {python, "-c", bootstrap, module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(python.c_str(), pointers.data());
  fail(python, "cannot be started; this command requires Python with the package tofsmith");
}

}  // namespace tofsmith::apps

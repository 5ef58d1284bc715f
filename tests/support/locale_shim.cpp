// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Loaded before a program by LD_PRELOAD, sets a locale as a host program may: by setlocale() and by
// std::locale::global(). TOFSMITH_TEST_LOCALE names the locale of any program,
// TOFSMITH_TEST_LOCALE_OF_HOSTS that of tests and Python alone. Without the locale the program
// ends.
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <locale>
#include <string_view>

namespace {

[[gnu::constructor]] void set_locale() {
  const std::string_view program = program_invocation_short_name;
  const char* name = std::getenv("TOFSMITH_TEST_LOCALE");
  if (name == nullptr && (program.starts_with("test_") || program.starts_with("python")))
    name = std::getenv("TOFSMITH_TEST_LOCALE_OF_HOSTS");
  if (name == nullptr) return;
  try {
    std::locale::global(std::locale(name));
  } catch (const std::exception&) {
    std::fprintf(stderr, "cannot set the locale %s; LOCPATH must name where it is\n", name);
    std::_Exit(70);
  }
}

}  // namespace

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A library for LD_PRELOAD that sets a locale by setlocale() and std::locale::global(), as a host
// program might. TOFSMITH_TEST_LOCALE sets the locale of every program,
// TOFSMITH_TEST_LOCALE_OF_HOSTS only of tests and Python. The program ends if the locale is
// missing.
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

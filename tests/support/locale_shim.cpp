// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Loaded before a program by LD_PRELOAD, sets the locale that TOFSMITH_TEST_LOCALE names, as a host
// program may: by setlocale() and by std::locale::global(). Without it the program ends.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <locale>

namespace {

[[gnu::constructor]] void set_locale() {
  const char* const name = std::getenv("TOFSMITH_TEST_LOCALE");
  if (name == nullptr) return;
  try {
    std::locale::global(std::locale(name));
  } catch (const std::exception&) {
    std::fprintf(stderr, "cannot set the locale %s; LOCPATH must name where it is\n", name);
    std::_Exit(70);
  }
}

}  // namespace

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <locale>
#include <stdexcept>

namespace tofsmith {

/// Sets a locale with a decimal comma by setlocale() and std::locale::global(), as a host program
/// might, until the end of the scope. CMake generates the locale; CTest sets LOCPATH to its folder.
/// @throws std::runtime_error if it cannot be set
class GermanLocale {
 public:
  GermanLocale() {
    try {
      std::locale::global(std::locale("de_DE.UTF-8"));
    } catch (const std::runtime_error&) {
      throw std::runtime_error(
          "cannot set the locale de_DE.UTF-8; expected Debian's package locales when CMake runs, "
          "and LOCPATH=BUILD/locale");
    }
  }
  ~GermanLocale() { std::locale::global(before_); }
  GermanLocale(const GermanLocale&) = delete;
  GermanLocale& operator=(const GermanLocale&) = delete;

 private:
  std::locale before_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

/// Takes one of these words, and tells of any other which of them could have been meant.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
  const CLI::Validator member = CLI::IsMember(words);
  CLI::Validator check = member;
  return check.operation([member, words](std::string& word) {
    std::string problem = member(word);
    if (problem.empty()) return problem;
    const std::string near = nearest_word(word, words);
    return near.empty() ? problem : problem + "; did you mean " + near + "?";
  });
}

}  // namespace tofsmith::apps

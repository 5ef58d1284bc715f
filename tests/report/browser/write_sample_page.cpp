// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Writes the sample page for the browser test: write_sample_page FILE
#include <fstream>
#include <iostream>

#include "sample_page.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_sample_page FILE\n";
    return 2;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << tofsmith::render(tofsmith::sample_page());
  return file.flush() ? 0 : 1;
}

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tofsmith/io/code_file.hpp"

namespace tofsmith {

std::string waveforms_to_csv(const CodeSet& code, double fundamental_frequency_hz) {
  std::string text = "time_s";
  for (int e = 0; e < code.exposures(); ++e) text += fmt::format(",modulation_{}", e + 1);
  for (int i = 0; i < code.measurements(); ++i) text += fmt::format(",demodulation_{}", i + 1);
  text += "\n";
  const Eigen::MatrixXd modulation = code.modulation_samples();
  const Eigen::MatrixXd demodulation = code.demodulation_samples();
  for (int n = 0; n < code.samples(); ++n) {
    text += fmt::format("{:.9g}", n / (fundamental_frequency_hz * code.samples()));
    for (int e = 0; e < code.exposures(); ++e) text += fmt::format(",{:.9g}", modulation(n, e));
    for (int i = 0; i < code.measurements(); ++i)
      text += fmt::format(",{:.9g}", demodulation(n, i));
    text += "\n";
  }
  return text;
}

}  // namespace tofsmith

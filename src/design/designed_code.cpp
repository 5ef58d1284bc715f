// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/designed_code.hpp"

#include "tofsmith/version.hpp"

namespace tofsmith {

CodeSet signed_by(CodeSet code, const std::string& method, const Camera& camera,
                  std::uint64_t seed) {
  code.provenance.method = method;
  code.provenance.camera = camera.name;
  code.provenance.seed = seed;
  code.provenance.version = TOFSMITH_VERSION;
  return code;
}

std::vector<MeasurementReport> reports_of(const CodeSet& code, const std::string& start) {
  std::vector<MeasurementReport> reports;
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform &demodulation = code.demodulation(i), &modulation = code.modulation_of(i);
    reports.push_back({.demodulation_duty = demodulation.mean(),
                       .modulation_duty = modulation.duty(),
                       .peak = modulation.peak(),
                       .edges = modulation.edges() + demodulation.edges(),
                       .start = start});
  }
  return reports;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Measures several values per exposure: two buckets, their difference, and three taps.
#include <cstdio>
#include <utility>

#include "tofsmith/simulate/depth_error.hpp"

using namespace tofsmith;

void show_two_buckets() {
  Sensor one = built_in_camera("paper-10f0").sensor;
  Sensor two = one;
  two.taps = 2;
  Sensor difference = two;
  difference.readout = Readout::difference;
  for (const auto& [name, sensor] : {std::pair("one tap", one), std::pair("two buckets", two),
                                     std::pair("two buckets, difference", difference)}) {
    Camera camera = built_in_camera("paper-10f0");
    camera.sensor = sensor;
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const double error_m = evaluate(code, camera, {.trials = 1000}).circular.geometric_mean_m.value;
    std::printf("%s: %d exposures, %d measurements, %.1f mm\n", name, code.exposures(),
                ForwardModel(code, camera).measurements(), 1e3 * error_m);
  }
}

int main() {
  show_two_buckets();
  // Three taps of one exposure, each open for a third of the period.
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 120;
  camera.sensor.taps = 3;
  std::vector<Waveform> gates;
  for (int tap = 0; tap < 3; ++tap)
    gates.push_back(Waveform::binary({{tap / 3.0, (tap + 1) / 3.0}}));
  const CodeSet code =
      CodeSet::create("three-gates", camera.samples, 3, {rectangular_pulse(1 / 3.0)}, gates);
  const DepthErrorReport report = evaluate(code, camera, {.trials = 1000});
  std::printf("%s: linear %.4g mm, circular %.4g mm\n", report.code.c_str(),
              1e3 * report.linear.geometric_mean_m.value,
              1e3 * report.circular.geometric_mean_m.value);
}

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <tofsmith/decode/decoder.hpp>
#include <tofsmith/design/design.hpp>

int main() {
  using namespace tofsmith;
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 10;
  const DesignResult result = design(camera, {.exposures = {4}, .trials = 5000});
  const CodeSet& code = result.winner().code;
  std::cout << code.name() << ": " << result.winner().error.linear.geometric_mean_m.value << " m\n";

  const ForwardModel model(code, camera);  // what a pixel at bin 123.4 measures ..
  const Return light{.signal_e_per_s = 1e5, .depth_bin = 123.4};
  const Eigen::VectorXf raw = model.expected_electrons({&light, 1}, 1e4).cast<float>();
  const Decoder decoder(make_decoding_table(model, camera));
  double depth_bin = 0;  // .. and what the decoder makes of it
  decoder.decode_depth_bins(raw.data(), 1, &depth_bin);
  std::cout << "decoded bin " << depth_bin << ", " << depth_bin * camera.bin_m() << " m\n";
}

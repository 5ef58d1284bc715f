// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <tofsmith/decode/decoder.hpp>
#include <tofsmith/design/design.hpp>

int main() {
  using namespace tofsmith;
  const Camera camera = built_in_camera("indoor");
  const DesignResult result = design(camera, {.exposures = {4}, .trials = 5000});
  const CodeSet& code = result.winner().code;
  std::cout << code.name() << ": " << result.winner().error.circular.geometric_mean_m.value
            << " m\n";

  const ForwardModel model(code, camera);  // expected measurements of a pixel at bin 123.4
  const Return light{.signal_e_per_s = 3e6, .depth_bin = 123.4};
  const Eigen::VectorXf raw = model.expected_electrons({&light, 1}, 1e6).cast<float>();
  const Decoder decoder(make_decoding_table(model, camera));
  double depth_bin = 0;
  decoder.decode_depth_bins(raw.data(), 1, &depth_bin);
  std::cout << "bin " << depth_bin << ", " << depth_bin * camera.bin_m() << " m\n";
}

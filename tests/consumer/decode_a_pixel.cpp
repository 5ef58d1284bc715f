// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <tofsmith/core.hpp>

int main() {
  using namespace tofsmith;
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
  const Return light{.signal_e_per_s = 1e5, .depth_bin = 123.4};
  const Eigen::VectorXf raw = model.expected_electrons({&light, 1}, 1e4).cast<float>();
  const Decoder decoder(make_decoding_table(model, camera));
  double depth_bin = 0;
  decoder.decode_depth_bins(raw.data(), 1, &depth_bin);
  std::cout << "decoded bin " << depth_bin << " of 123.4\n";
  return std::abs(depth_bin - 123.4) < 0.1 ? 0 : 1;
}

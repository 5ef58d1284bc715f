// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode_setup.hpp"
#include "tofsmith/decode/unwrap_decoder.hpp"

namespace tofsmith {

/// A code of sinusoids on a camera, with the decoder that unwraps it.
struct UnwrapSetup {
  Camera camera;
  ForwardModel model;
  UnwrapDecoder decoder;

  UnwrapSetup(const std::string& code, const Camera& camera_, const UnwrapOptions& options = {})
      : camera(camera_),
        model(build_family(code, camera), camera),
        decoder(make_decoding_table(model, camera), options) {}

  /// Expected raw electrons of one pixel, appended.
  void append_expected(std::vector<float>& raw, double signal, double depth_bin,
                       double ambient) const {
    const Return r{signal, depth_bin};
    for (const double e : model.expected_electrons({&r, 1}, ambient))
      raw.push_back(static_cast<float>(e));
  }
};

inline std::vector<double> depth_bins_of(const UnwrapDecoder& decoder,
                                         const std::vector<float>& raw) {
  std::vector<double> bins(raw.size() / static_cast<std::size_t>(decoder.measurements()));
  decoder.decode_depth_bins(raw.data(), static_cast<std::int64_t>(bins.size()), bins.data());
  return bins;
}

}  // namespace tofsmith

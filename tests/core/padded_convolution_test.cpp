// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/padded_convolution.hpp"

#include <gtest/gtest.h>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

Image<float> random_image(int height, int width, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  Image<float> image(height, width);
  for (float& value : image.pixels) value = static_cast<float>(random.uniform());
  return image;
}

TEST(PaddedConvolution, EqualsTheSumOverNeighbours) {
  for (const auto& [height, width, up, left] :
       {std::array{7, 9, 2, 3}, {5, 4, 6, 9}, {1, 6, 1, 2}, {1, 1, 3, 0}, {12, 3, 0, 2}}) {
    const Image<float> image = random_image(height, width, 1);
    const Image<float> kernel = random_image(2 * up + 1, 2 * left + 1, 2);
    const Image<float> found = PaddedConvolution(kernel, height, width).apply(image);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) {
        double sum = 0.0;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            if (std::abs(v - y) <= up && std::abs(u - x) <= left)
              sum += static_cast<double>(kernel(up + v - y, left + u - x)) *
                     static_cast<double>(image(y, x));
        EXPECT_NEAR(found(v, u), sum, 1e-5) << height << " x " << width;
      }
  }
}

TEST(PaddedConvolution, RejectsKernelsOfEvenSize) {
  EXPECT_THROW(PaddedConvolution(Image<float>(2, 3), 4, 4), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

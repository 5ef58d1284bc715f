// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// An open right hand with its forearm, of capsules. The wrist is the origin of the hand's own
/// axes: x towards the little finger, y towards the finger tips, z out of the palm.
std::vector<Shape> open_hand(const Eigen::Isometry3d& hand_to_world, const Texture& skin);

}  // namespace tofsmith

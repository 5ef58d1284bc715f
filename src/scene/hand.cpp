// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tofsmith {

namespace {

struct Finger {
  Eigen::Vector3d knuckle;            ///< [m]
  double spread_rad;                  ///< away from the middle of the hand, towards +x
  std::array<double, 3> phalanges_m;  ///< lengths, from the knuckle
  double radius_m;                    ///< at the knuckle; tapers
  std::array<double, 3> curl_rad;     ///< of each joint, towards the palm's side
};

// Measures of a grown-up's hand, rounded to millimetres.
const std::array<Finger, 4> fingers = {{
    {{-0.033, 0.083, 0.000}, -0.13, {0.041, 0.025, 0.019}, 0.0100, {0.10, 0.16, 0.12}},
    {{-0.010, 0.089, -0.002}, -0.02, {0.044, 0.029, 0.020}, 0.0102, {0.08, 0.12, 0.10}},
    {{0.012, 0.085, -0.001}, 0.09, {0.041, 0.027, 0.019}, 0.0097, {0.12, 0.16, 0.12}},
    {{0.032, 0.075, 0.002}, 0.22, {0.033, 0.020, 0.018}, 0.0086, {0.16, 0.20, 0.14}},
}};

class HandBuilder {
 public:
  HandBuilder(const Eigen::Isometry3d& to_world, const Texture& skin)
      : to_world_(to_world), skin_(skin) {}

  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double radius_m) {
    shapes_.push_back(Capsule{to_world_ * start, to_world_ * end, radius_m, skin_});
  }

  void add_finger(const Finger& finger) {
    Eigen::Vector3d joint = finger.knuckle;
    double curl_rad = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      curl_rad += finger.curl_rad[i];
      const Eigen::Vector3d along(std::sin(finger.spread_rad) * std::cos(curl_rad),
                                  std::cos(finger.spread_rad) * std::cos(curl_rad),
                                  std::sin(curl_rad));
      const Eigen::Vector3d next = joint + finger.phalanges_m[i] * along;
      add(joint, next, finger.radius_m * (1.0 - 0.07 * static_cast<double>(i)));
      joint = next;
    }
  }

  void add_palm() {
    // A fan of bones from the wrist to the knuckles, and to the places between these.
    constexpr int fan = 9;
    for (int i = 0; i < fan; ++i) {
      const double place = 3.0 * i / (fan - 1);
      const auto left = static_cast<std::size_t>(std::min(2.0, place));
      const double share = place - static_cast<double>(left);
      const Eigen::Vector3d knuckle =
          (1 - share) * fingers[left].knuckle + share * fingers[left + 1].knuckle;
      add({0.55 * knuckle.x(), 0.008, -0.002}, knuckle - Eigen::Vector3d(0, 0.004, 0.001), 0.0112);
    }
    add({-0.017, 0.018, 0.002}, {-0.030, 0.050, 0.004}, 0.0160);  // ball of the thumb
    add({0.018, 0.014, 0.000}, {0.029, 0.052, 0.001}, 0.0138);    // heel of the hand
  }

  void add_thumb() {
    const std::array<Eigen::Vector3d, 4> joints = {{{-0.020, 0.018, 0.004},
                                                    {-0.050, 0.050, 0.009},
                                                    {-0.072, 0.078, 0.011},
                                                    {-0.083, 0.102, 0.010}}};
    const std::array<double, 3> radii_m = {0.0135, 0.0112, 0.0102};
    for (std::size_t i = 0; i < 3; ++i) add(joints[i], joints[i + 1], radii_m[i]);
    for (const double share : {0.35, 0.7})  // web to the index finger
      add(joints[0] + share * (joints[1] - joints[0]), {-0.033, 0.045 + 0.025 * share, 0.000},
          0.0095);
    add({-0.048, 0.055, 0.006}, {-0.034, 0.068, 0.000}, 0.0080);
  }

  void add_forearm() {
    for (const double side : {-1.0, 0.0, 1.0}) {
      add({0.012 * side, 0.014, -0.003}, {0.012 * side, -0.030, -0.004}, 0.0165);
      add({0.012 * side, -0.020, -0.004}, {0.020 * side, -0.150, -0.006}, 0.0185);
    }
  }

  std::vector<Shape> take() { return std::move(shapes_); }

 private:
  const Eigen::Isometry3d& to_world_;
  const Texture& skin_;
  std::vector<Shape> shapes_;
};

}  // namespace

std::vector<Shape> open_hand(const Eigen::Isometry3d& hand_to_world, const Texture& skin) {
  HandBuilder hand(hand_to_world, skin);
  hand.add_palm();
  for (const Finger& finger : fingers) hand.add_finger(finger);
  hand.add_thumb();
  hand.add_forearm();
  return hand.take();
}

}  // namespace tofsmith

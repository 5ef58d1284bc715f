// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/hand.hpp"

#include <array>
#include <cmath>

namespace tofsmith {

namespace {

struct Finger {
  Eigen::Vector3d knuckle;              ///< [m]
  double spread_rad;                    ///< away from the middle of the hand, towards +x
  std::array<double, 3> phalanges_m;    ///< lengths, from the knuckle
  double radius_m;                      ///< at the knuckle; tapers
  std::array<double, 3> curl_rad;       ///< of each joint, towards the palm's side
};

// Measures of a grown-up's hand, rounded to millimetres.
const std::array<Finger, 4> fingers = {{
    {{-0.033, 0.083, 0.000}, -0.13, {0.041, 0.025, 0.019}, 0.0094, {0.10, 0.16, 0.12}},
    {{-0.010, 0.089, -0.002}, -0.02, {0.044, 0.029, 0.020}, 0.0096, {0.08, 0.12, 0.10}},
    {{0.012, 0.085, -0.001}, 0.09, {0.041, 0.027, 0.019}, 0.0090, {0.12, 0.16, 0.12}},
    {{0.032, 0.075, 0.002}, 0.22, {0.033, 0.020, 0.018}, 0.0080, {0.16, 0.20, 0.14}},
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
      add(joint, next, finger.radius_m * (1.0 - 0.09 * static_cast<double>(i)));
      joint = next;
    }
  }

  void add_palm() {
    for (const Finger& finger : fingers)  // metacarpals
      add({0.40 * finger.knuckle.x(), 0.010, -0.001}, finger.knuckle, 0.0128);
    for (std::size_t i = 0; i + 1 < fingers.size(); ++i)  // the row of knuckles
      add(fingers[i].knuckle - Eigen::Vector3d(0, 0.008, 0),
          fingers[i + 1].knuckle - Eigen::Vector3d(0, 0.008, 0), 0.0115);
    add({-0.016, 0.020, 0.003}, {-0.027, 0.052, 0.006}, 0.0165);  // ball of the thumb
    add({0.017, 0.016, 0.001}, {0.029, 0.055, 0.003}, 0.0150);    // heel of the hand
    add({-0.012, 0.040, 0.000}, {0.016, 0.040, 0.000}, 0.0135);   // hollow
  }

  void add_thumb() {
    const std::array<Eigen::Vector3d, 4> joints = {{{-0.022, 0.022, 0.006},
                                                    {-0.050, 0.052, 0.014},
                                                    {-0.070, 0.080, 0.017},
                                                    {-0.081, 0.105, 0.016}}};
    const std::array<double, 3> radii_m = {0.0140, 0.0108, 0.0098};
    for (std::size_t i = 0; i < 3; ++i) add(joints[i], joints[i + 1], radii_m[i]);
    add({-0.022, 0.060, 0.002}, {-0.044, 0.056, 0.010}, 0.0085);  // web to the index finger
  }

  void add_forearm() {
    for (const double side : {-1.0, 1.0}) {
      add({0.012 * side, 0.016, -0.003}, {0.012 * side, -0.040, -0.004}, 0.0175);
      add({0.012 * side, -0.030, -0.004}, {0.022 * side, -0.150, -0.006}, 0.0220);
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

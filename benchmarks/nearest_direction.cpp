// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "nearest_direction.hpp"

#ifdef TOFSMITH_HAS_NANOFLANN
#include <algorithm>
#include <nanoflann.hpp>
#include <vector>
#endif

namespace tofsmith::benchmarks {

#ifdef TOFSMITH_HAS_NANOFLANN

namespace {

/// Points with the interface of nanoflann.
template <int Rank>
struct Directions {
  std::vector<std::array<float, Rank>> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::uint32_t row, std::size_t j) const { return points[row][j]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

template <int Rank>
class Tree : public NearestDirection {
 public:
  explicit Tree(const ReferenceCurve& curve)
      : directions_(directions_of(curve)), index_(Rank, directions_) {
    index_.buildIndex();
  }

  std::int32_t bin(const ReferencePixel& pixel) const override {
    std::array<float, Rank> query;
    std::transform(pixel.unit.begin(), pixel.unit.begin() + Rank, query.begin(),
                   [](double unit) { return static_cast<float>(unit); });
    std::uint32_t row = 0;
    float square = 0.0f;
    index_.knnSearch(query.data(), 1, &row, &square);
    return static_cast<std::int32_t>(row);
  }

 private:
  static Directions<Rank> directions_of(const ReferenceCurve& curve) {
    Directions<Rank> directions;
    directions.points.resize(static_cast<std::size_t>(curve.samples()));
    for (int row = 0; row < curve.samples(); ++row)
      for (int j = 0; j < Rank; ++j)
        directions.points[static_cast<std::size_t>(row)][static_cast<std::size_t>(j)] =
            static_cast<float>(curve.component(row, j));
    return directions;
  }

  Directions<Rank> directions_;
  nanoflann::KDTreeSingleIndexAdaptor<
      nanoflann::L2_Simple_Adaptor<float, Directions<Rank>, float, std::uint32_t>, Directions<Rank>,
      Rank, std::uint32_t>
      index_;
};

}  // namespace

std::unique_ptr<NearestDirection> NearestDirection::make(const ReferenceCurve& curve) {
  switch (curve.rank()) {
    case 2:
      return std::make_unique<Tree<2>>(curve);
    case 3:
      return std::make_unique<Tree<3>>(curve);
    case 4:
      return std::make_unique<Tree<4>>(curve);
    case 5:
      return std::make_unique<Tree<5>>(curve);
    case 6:
      return std::make_unique<Tree<6>>(curve);
    case 7:
      return std::make_unique<Tree<7>>(curve);
    default:
      return std::make_unique<Tree<8>>(curve);
  }
}

#else

std::unique_ptr<NearestDirection> NearestDirection::make(const ReferenceCurve& /*curve*/) {
  return nullptr;
}

#endif

}  // namespace tofsmith::benchmarks

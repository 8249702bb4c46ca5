#include "algorithm/train/neighbour_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <nanoflann.hpp>

namespace sgs {
namespace {

constexpr std::size_t kNeighbours = 3;

// As nanoflann wants to see points.
struct Points {
  const std::vector<glm::vec3>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::size_t>;

}  // namespace

std::vector<float> neighbour_distances(const std::vector<glm::vec3>& points) {
  std::vector<float> distances(points.size(), 0.0F);
  if (points.size() < 2) return distances;
  const Points adapted{points};
  Tree tree(3, adapted, nanoflann::KDTreeSingleIndexAdaptorParams());
  tree.buildIndex();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
    std::size_t found[kNeighbours + 1];
    float squares[kNeighbours + 1];
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      // The nearest one is the point itself, or one at the same place.
      const std::size_t count = tree.knnSearch(&points[i].x, kNeighbours + 1, found, squares);
      double sum = 0;
      for (std::size_t k = 1; k < count; ++k) sum += squares[k];
      distances[i] = static_cast<float>(std::sqrt(sum / static_cast<double>(count - 1)));
    }
  });
  return distances;
}

}  // namespace sgs

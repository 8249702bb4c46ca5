// Search for the nearest of many centroids. Two ways: a k-d tree where the dimensions are few, all
// distances side by side where they are many.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace sgs {

struct Nearest {
  std::uint32_t index = 0;
  float squared_distance = 0;
};

class NearestSearch {
 public:
  virtual ~NearestSearch() = default;
  // The nearest centroid of a point; where distances are equal, that of the lowest index. May be
  // called from many threads. hint: a centroid that is probably near, which makes it faster; any
  // number will do.
  virtual Nearest find(const float* point, std::uint32_t hint) const = 0;
};

// centroids: [K, dims], K > 0; copied.
std::unique_ptr<NearestSearch> make_kd_tree(const std::vector<float>& centroids, int dims);
std::unique_ptr<NearestSearch> make_exhaustive_search(const std::vector<float>& centroids,
                                                      int dims);

// The faster of the two (measured by bench_kmeans).
std::unique_ptr<NearestSearch> make_search(const std::vector<float>& centroids, int dims);

}  // namespace sgs

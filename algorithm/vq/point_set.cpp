// Merging and sampling of points.
#include "algorithm/vq/point_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

namespace sgs {
namespace {

std::uint64_t hash_of(const float* values, int dims) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (int d = 0; d < dims; ++d) {
    hash = (hash ^ __builtin_bit_cast(std::uint32_t, values[d])) * 0x100000001b3U;
    hash ^= hash >> 29;
  }
  return hash;
}

void append(PointSet& to, const float* point, float weight) {
  to.values.insert(to.values.end(), point, point + to.dims);
  to.weights.push_back(weight);
}

}  // namespace

DistinctPoints merge_equal(const PointSet& points) {
  struct Entry {
    std::uint64_t hash;
    std::uint32_t index;
  };
  const std::size_t count = points.size();
  std::vector<Entry> entries(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    entries[i] = {hash_of(points[i], points.dims), static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.hash < b.hash || (a.hash == b.hash && a.index < b.index);
  });

  // Points of one hash that differ are kept apart from their neighbour in the list; that the same
  // point may then appear twice does no harm.
  std::vector<std::uint32_t> first(count);  // [N] first point with the same values
  const std::size_t bytes = static_cast<std::size_t>(points.dims) * sizeof(float);
  for (std::size_t e = 0; e < count; ++e) {
    const std::uint32_t index = entries[e].index;
    const bool same = e > 0 && entries[e].hash == entries[e - 1].hash &&
                      std::memcmp(points[index], points[entries[e - 1].index], bytes) == 0;
    first[index] = same ? first[entries[e - 1].index] : index;
  }

  DistinctPoints out;
  out.points.dims = points.dims;
  out.original.resize(count);
  std::vector<double> weights;
  for (std::size_t i = 0; i < count; ++i) {
    if (first[i] == i) {
      out.original[i] = static_cast<std::uint32_t>(weights.size());
      out.points.values.insert(out.points.values.end(), points[i], points[i] + points.dims);
      weights.push_back(points.weights[i]);
    } else {
      out.original[i] = out.original[first[i]];
      weights[out.original[i]] += points.weights[i];
    }
  }
  for (const double weight : weights) {
    out.points.weights.push_back(static_cast<float>(
        std::min(weight, static_cast<double>(std::numeric_limits<float>::max()))));
  }
  return out;
}

PointSet draw(const PointSet& points, std::size_t count, std::uint64_t seed) {
  if (points.size() <= count) return points;
  double total = 0;
  for (const float weight : points.weights) total += weight;
  PointSet out;
  out.dims = points.dims;
  std::mt19937_64 random(seed);
  const double step = total / static_cast<double>(count);
  double next = step * (static_cast<double>(random() >> 11) * 0x1p-53), passed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    passed += points.weights[i];
    for (; next < passed && out.size() < count; next += step) append(out, points[i], 1);
  }
  return out;
}

}  // namespace sgs

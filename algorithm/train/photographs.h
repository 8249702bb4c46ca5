// The photographs that a scene is fitted to, at one size at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/image/image.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

struct Photograph {
  Camera camera;
  RgbaImage image;
  std::vector<std::uint8_t> counts;  // as load_mask() gives them
};

class Photographs {
 public:
  // Gives photograph `at` so many times smaller; several threads may ask at once.
  using Source = std::function<Photograph(std::size_t at, double downscale)>;

  Photographs(std::size_t count, Source source) : stored_(count), source_(std::move(source)) {}
  // The photographs of one split of a data set, which must outlive them.
  Photographs(const Dataset& dataset, Split split);

  // Loads all of them at another size. 8 B a pixel stay; on the way 16 more for each pixel of a
  // file that a thread is at. Throws what the source throws.
  void load(double downscale);

  std::size_t size() const { return stored_.size(); }
  const Camera& camera(std::size_t at) const { return stored_[at].camera; }
  // As seen before a background: colours to 16 bits, those of 8 bits exactly.
  Image before(std::size_t at, const glm::vec3& background) const;
  // For each pixel of `at` whether it counts in losses and qualities; empty where all do.
  const std::vector<std::uint8_t>& counts(std::size_t at) const { return stored_[at].counts; }
  // True if light comes through any of them.
  bool transparent() const { return transparent_; }

 private:
  struct Stored {
    Camera camera;
    std::vector<std::array<std::uint16_t, 4>> pixels;  // colour times alpha, alpha
    std::vector<std::uint8_t> counts;
    bool transparent = false;
  };

  std::vector<Stored> stored_;
  Source source_;
  bool transparent_ = false;
};

// Targets where there are no photographs: the scene's own reference pictures.

// Before black, opaque; what is brighter than 1 becomes 1, as in any photograph. cloud: copied.
Photographs own_pictures(const ActivatedCloud& cloud, std::vector<Camera> cameras);

// `count` cameras, each somewhere between two of the given ones, drawn: on the line between their
// centres, turned as far on the shortest way, with the size and focal lengths of the first of the
// two. Throws InputError where fewer than two are given.
std::vector<Camera> cameras_between(const std::vector<Camera>& cameras, std::size_t count,
                                    std::uint64_t seed);

}  // namespace sgs

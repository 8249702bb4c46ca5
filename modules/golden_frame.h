// The picture that a machine must give, and what any machine's golden renderer can tell of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/splat/rects.h"

namespace sgs {

// Counts of one group of pixels, where a machine has groups.
struct GoldenGroup {
  PixelRect pixels;
  std::uint64_t blends = 0, misordered = 0, missed = 0;  // as of the frame
};

struct GoldenFrame {
  Image image;               // to the bit, before its pixel format
  Image right;               // the right eye's, where there are two: counts are of both
  std::uint64_t blends = 0;  // (splat, pixel) pairs
  // Gaussians blended into at least one pixel; of two eyes those of the eye that has more.
  std::uint64_t contributing = 0;
  std::array<std::uint64_t, 2> contributing_of{};  // [eye] the same, where there are two
  std::uint64_t misordered = 0;     // blends behind a splat that is farther, at the same pixel
  std::uint64_t missed = 0;         // (group, splat) pairs that touch and were not looked at
  std::vector<GoldenGroup> groups;  // [group, row by row]; they add up to the frame's

  // The picture that the same blends would give in right order: each pixel blends, by depth, all
  // splats looked at for it. Only missed splats keep it from the reference picture of the decoded
  // scene. Wanted only where `missed` is not 0; empty where an order misses nothing. May read the
  // scene that the frame is of.
  std::function<Image()> in_order;

  // The picture of the same order in the reference's arithmetic, with every splat reaching as far
  // as it can be seen. Empty where the machine computes so. May read the scene that the frame is
  // of.
  std::function<Image()> computed_exactly;

  // of_right: golden frame of the right eye alone.
  void add_right_eye(GoldenFrame&& of_right) {
    right = std::move(of_right.image);
    blends += of_right.blends;
    contributing_of = {contributing, of_right.contributing};
    contributing = std::max(contributing, of_right.contributing);
    misordered += of_right.misordered;
    missed += of_right.missed;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      groups[g].blends += of_right.groups[g].blends;
      groups[g].misordered += of_right.groups[g].misordered;
      groups[g].missed += of_right.groups[g].missed;
    }
  }
};

}  // namespace sgs

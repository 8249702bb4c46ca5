// What the toy machine draws: each group of pixels in the one colour of a block of Gaussians.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/splat/rects.h"
#include "modules/frame_job.h"
#include "tests/testbench/toy_machine/toy_config.h"

namespace sgs::toy {

// Groups of a frame, row by row; those at its right and lower edge may be smaller.
std::vector<PixelRect> groups_of(const FrameJob& job, const ToyConfig& config);

// First slot and number of the block whose colour a group has: the blocks in turn, the last one may
// be shorter. Nothing where the scene is empty.
struct Block {
  std::uint32_t first = 0, count = 0;
};
Block block_of(std::uint32_t group, const FrameJob& job, const ToyConfig& config);

// From the centres of so many first halves, one behind the other: each channel is the mean of one
// axis, less its whole part.
glm::vec3 colour_of(const std::byte* first_halves, std::uint32_t count);

// The whole frame, from the bytes of a scene's image.
Image picture_of(const std::vector<std::byte>& image, const FrameJob& job, const ToyConfig& config);

}  // namespace sgs::toy

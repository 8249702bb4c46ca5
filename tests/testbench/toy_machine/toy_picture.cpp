// Groups, blocks and colours.
#include "tests/testbench/toy_machine/toy_picture.h"

#include <algorithm>
#include <cmath>

#include "algorithm/memory/records.h"

namespace sgs::toy {

std::vector<PixelRect> groups_of(const FrameJob& job, const ToyConfig& config) {
  const auto side = static_cast<int>(config.group_px);
  std::vector<PixelRect> groups;
  const PixelRect frame{0, 0, job.view.width, job.view.height};
  for (int y = 0; y < frame.y1; y += side) {
    for (int x = 0; x < frame.x1; x += side) {
      groups.push_back(intersection(PixelRect{x, y, x + side, y + side}, frame));
    }
  }
  return groups;
}

Block block_of(std::uint32_t group, const FrameJob& job, const ToyConfig& config) {
  const std::uint32_t gaussians = job.layout.gaussian_count();
  if (gaussians == 0) return {};
  const std::uint32_t size = config.fetch.block_gaussians;
  const std::uint32_t blocks = (gaussians + size - 1) / size;
  const std::uint32_t first = group % blocks * size;
  return {first, std::min(size, gaussians - first)};
}

glm::vec3 colour_of(const std::byte* first_halves, std::uint32_t count) {
  glm::vec3 sum(0);
  for (std::uint32_t i = 0; i < count; ++i) {
    sum += decode_first_half(first_halves + std::size_t{i} * kFirstHalfBytes).mean;
  }
  const glm::vec3 mean = sum / static_cast<float>(std::max(1U, count));
  return {mean.x - std::floor(mean.x), mean.y - std::floor(mean.y), mean.z - std::floor(mean.z)};
}

Image picture_of(const std::vector<std::byte>& image, const FrameJob& job,
                 const ToyConfig& config) {
  Image picture(job.view.width, job.view.height);
  std::uint32_t number = 0;
  for (const PixelRect& group : groups_of(job, config)) {
    const Block block = block_of(number++, job, config);
    const glm::vec3 colour =
        colour_of(image.data() + job.layout.first_halves.address(block.first), block.count);
    for (int y = group.y0; y < group.y1; ++y) {
      for (int x = group.x0; x < group.x1; ++x) picture.at(x, y) = colour;
    }
  }
  return picture;
}

}  // namespace sgs::toy

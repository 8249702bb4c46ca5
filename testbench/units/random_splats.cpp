// Making and comparing of splats.
#include "testbench/units/random_splats.h"

#include <fmt/format.h>

#include <cstring>

#include "algorithm/render/group_state.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/uniform.h"

namespace sgs::tb {
namespace {

// Some range [low, high) of sub-tiles that overlaps [first, end), within [0, limit).
void overlapping(std::mt19937_64& random, int first, int end, int limit, std::uint16_t& low,
                 std::uint16_t& high) {
  constexpr int kBeyond = 3;
  const int inside = whole(random, first, end - 1);
  low = static_cast<std::uint16_t>(std::max(0, whole(random, first - kBeyond, inside)));
  high = static_cast<std::uint16_t>(std::min(limit, whole(random, inside + 1, end + kBeyond)));
}

}  // namespace

SubtileRect subtiles_of(const PixelRect& pixels) {
  const auto down = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  return {down(pixels.x0), down(pixels.y0), down(pixels.x1 + kSubtilePx - 1),
          down(pixels.y1 + kSubtilePx - 1)};
}

StreamingJob frame_job(int width_px, int height_px, const PixelSize& group, FrameFormat format,
                       std::uint64_t spill_bytes, const SceneLayout& layout) {
  StreamingJob job;
  job.view.width = width_px;
  job.view.height = height_px;
  job.background = {0.25F, 0.5F, 0.75F};
  job.frame_format = format;
  job.groups = pixel_groups(width_px, height_px, group);
  job.parts = {job.groups};
  place(layout, spill_bytes, job);
  return job;
}

Splat random_splat(std::mt19937_64& random, const PixelRect& group, const FrameJob& job,
                   std::uint32_t index, float opacity) {
  Splat splat{};
  splat.x = uniform(random, static_cast<float>(group.x0) - 4, static_cast<float>(group.x1) + 4);
  splat.y = uniform(random, static_cast<float>(group.y0) - 4, static_cast<float>(group.y1) + 4);
  splat.conic_a = uniform(random, 0.001F, 0.5F);
  splat.conic_c = uniform(random, 0.001F, 0.5F);
  splat.conic_b = uniform(random, -0.9F, 0.9F) * std::sqrt(splat.conic_a * splat.conic_c);
  splat.opacity = uniform(random, 0.0F, opacity);
  splat.depth = static_cast<float>(whole(random, 1, 20)) * 0.37F;
  splat.index = index;
  splat.rgb = {uniform(random, 0.0F, 1.0F), uniform(random, 0.0F, 1.0F),
               uniform(random, 0.0F, 2.0F)};
  const SubtileRect tiles = subtiles_of(group);
  const SubtileRect frame = subtiles_of({0, 0, job.view.width, job.view.height});
  overlapping(random, tiles.x0, tiles.x1, frame.x1, splat.footprint.x0, splat.footprint.x1);
  overlapping(random, tiles.y0, tiles.y1, frame.y1, splat.footprint.y0, splat.footprint.y1);
  return splat;
}

std::string difference(const Splat& got, const Splat& expected, const SubtileRect& group) {
  if (std::memcmp(&got.x, &expected.x, offsetof(Splat, index)) != 0) return "geometry or depth";
  if (got.index != expected.index) {
    return fmt::format("index {}, expected {}", got.index, expected.index);
  }
  if (std::memcmp(&got.rgb, &expected.rgb, sizeof got.rgb) != 0) return "colour";
  if (!(intersection(got.footprint, group) == intersection(expected.footprint, group))) {
    return "footprint";
  }
  return "";
}

}  // namespace sgs::tb

// Where a frame's working regions lie and how large they are, and its tiles.
#include "modules/gscore/gscore_job.h"

#include <array>
#include <catch2/catch.hpp>

#include "algorithm/files/input_error.h"

namespace sgs::gscore {
namespace {

using Catch::Matchers::Contains;

// Blocks of 16 lines of 32 B: 4 entries of 6 B behind the link, then 5 a line.
constexpr std::uint64_t kBlockBytes = 512, kBlockEntries = 4 + 15 * 5;

GscoreConfig two_cores() {
  GscoreConfig config;
  config.cores = 2;
  config.lists.pool_bytes = 15 * kBlockBytes;
  config.sorting.list_entries = 512;
  return config;
}

FrameJob job_of(std::uint32_t gaussians, const GscoreConfig& config) {
  FrameJob job;
  job.view.width = 33;
  job.view.height = 17;
  job.frame_format = config.framebuffer;
  job.layout = lay_out_file(SecondHalfFormat{}, gaussians);
  add_regions(config, job);
  return job;
}

TEST_CASE("gscore job: regions hold a record, an entry and a split of every Gaussian") {
  struct Case {
    std::uint32_t gaussians;
    std::uint64_t subset_blocks;  // of a level: links are taken ahead, two blocks a subset
  };
  // Lists of 512 fit on chip.
  for (const Case& of : {Case{0, 0}, Case{512, 0}, Case{513, 513 / kBlockEntries + 2 * 8},
                         Case{1000, 1000 / kBlockEntries + 2 * 8}}) {
    INFO(of.gaussians);
    const GscoreJob job = gscore_job(two_cores(), job_of(of.gaussians, two_cores()));
    CHECK(job.projected.record_bytes == 32);
    CHECK(job.lists.bytes == 15 * kBlockBytes);
    CHECK(job.lists.base >= job.projected.base + std::uint64_t{32} * of.gaussians);
    // One level by samples, then three of 16 bits each.
    constexpr std::uint64_t kCores = 2, kLevels = 1 + 6;
    CHECK(job.subsets.bytes == kCores * kLevels * of.subset_blocks * kBlockBytes);
    CHECK(job.subsets.base >= job.lists.base + job.lists.bytes);
    CHECK(job.frame_buffer.bytes == 3 * 33 * 17);
    CHECK(job.frame_buffer.base >= job.subsets.base + job.subsets.bytes);
  }
}

TEST_CASE("gscore job: the pool is refused where it cannot hold all Gaussians in one tile") {
  // 1000 entries fill 12 blocks and begin another, whose next is taken too.
  GscoreConfig config = two_cores();
  CHECK_NOTHROW(job_of(1000, config));
  config.lists.pool_bytes -= 1;
  CHECK_THROWS_WITH(job_of(1000, config), Contains("got 7679, expected 7680 or more"));
}

TEST_CASE("gscore job: tiles row by row, cut at the frame's edge") {
  const GscoreJob job = gscore_job(two_cores(), job_of(1, two_cores()));
  CHECK(job.columns == 3);
  CHECK(job.tile_count == 6);
  const auto pixels = [&](std::uint32_t tile) {
    const PixelRect at = job.pixels(tile);
    return std::array<int, 4>{at.x0, at.y0, at.x1, at.y1};
  };
  CHECK(pixels(1) == std::array<int, 4>{16, 0, 32, 16});
  CHECK(pixels(5) == std::array<int, 4>{32, 16, 33, 17});
  CHECK(job.tile_x(5) == 2);
  CHECK(job.tile_y(5) == 1);
}

}  // namespace
}  // namespace sgs::gscore

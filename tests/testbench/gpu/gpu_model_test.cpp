// The model by hand, and what must hold of it whatever its constants.
#include "testbench/gpu/gpu_model.h"

#include <catch2/catch.hpp>
#include <numeric>

namespace sgs::test {
namespace {

RasterWork some_work() {
  RasterWork work;
  work.sh_degree = 3;
  work.gaussians = 1'000'000;
  work.in_front = 700'000;
  work.listed = 500'000;
  work.pairs = 3'000'000;
  work.pair_steps = 400'000;
  work.tiles = 2170;
  work.pixels = 534'100;
  work.entries_fetched = 2'000'000;
  work.warp_entries = 12'000'000;
  work.warp_blends = 4'000'000;
  work.blends = 40'000'000;
  return work;
}

double seconds_of(const GpuFrame& frame, const std::string& name) {
  for (const GpuStage& stage : frame.stages) {
    if (stage.name == name) return stage.seconds;
  }
  return -1;
}

TEST_CASE("GPU model: bytes of arrays, by hand") {
  const GpuFrame frame = model_gpu(some_work(), {});
  const GpuStage& projection = frame.stages.front();
  CHECK(projection.scene_bytes == Approx(1e6 * 12 + 7e5 * 28 + 5e5 * (4 + 16 * 12)));
  CHECK(projection.intermediate_bytes == Approx(1e6 * 8 + 7e5 * 24 + 5e5 * 43));
  // 12 bits number the tiles: 44 bits are 6 passes.
  CHECK(frame.stages[2].intermediate_bytes == Approx(3e6 * (8 + 6 * 24)));
  CHECK(frame.stages.back().frame_bytes == Approx(534'100 * 20));
  const double sum =
      std::accumulate(frame.stages.begin(), frame.stages.end(), 0.0,
                      [](double total, const GpuStage& stage) { return total + stage.bytes(); });
  CHECK(frame.bytes() == Approx(sum));
  CHECK(frame.bytes_of(GpuPart::kProjection) + frame.bytes_of(GpuPart::kSorting) +
            frame.bytes_of(GpuPart::kRendering) ==
        Approx(sum));
}

TEST_CASE("GPU model: what binds a stage is what its time follows") {
  GpuConfig config;
  const GpuFrame base = model_gpu(some_work(), config);
  GpuConfig wide = config, fast = config;
  wide.bandwidth_gb_s *= 2;
  fast.clock_mhz *= 2;
  const GpuFrame with_bytes = model_gpu(some_work(), wide),
                 with_clock = model_gpu(some_work(), fast);
  for (std::size_t s = 0; s < base.stages.size(); ++s) {
    const GpuStage& stage = base.stages[s];
    INFO(stage.name);
    const double by_bytes = with_bytes.stages[s].seconds, by_clock = with_clock.stages[s].seconds;
    CHECK((stage.bound_by_bytes ? by_clock : by_bytes) == Approx(stage.seconds));
    CHECK((stage.bound_by_bytes ? by_bytes : by_clock) < stage.seconds);
  }
  CHECK(base.joules == Approx(base.seconds * config.watts));
  // Nothing is faster than all that it moves at the peak.
  CHECK(base.seconds >= base.bytes() / (config.bandwidth_gb_s * 1e9));
}

TEST_CASE("GPU model: a cache spares gathers, not what is touched once") {
  GpuConfig none, half, all;
  none.cache_mb = 0;
  half.cache_mb = 24;  // of 500,000 Gaussians in three sectors
  all.cache_mb = 10'000;
  const auto gathered = [](const GpuConfig& config) {
    return model_gpu(some_work(), config).stages.back().intermediate_bytes;
  };
  CHECK(gathered(none) == Approx(2e6 * (4 + 96)));
  CHECK(gathered(half) == Approx(2e6 * 4 + (5e5 + 1.5e6 / 2) * 96));
  CHECK(gathered(all) == Approx(2e6 * 4 + 5e5 * 96));
}

TEST_CASE("GPU model: an empty frame costs its pixels") {
  RasterWork work;
  work.pixels = 100;
  work.tiles = 1;
  const GpuFrame frame = model_gpu(work, {});
  CHECK(frame.bytes() == Approx(100 * 20 + 8));
  CHECK(seconds_of(frame, "sort") == 0);
}

}  // namespace
}  // namespace sgs::test

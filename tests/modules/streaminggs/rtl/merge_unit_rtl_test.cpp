// The merge unit register by register with its heap in Verilog, beside the unit in SystemC, on keys
// of frames: every key, its cycle, and the nodes that are read and written.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/order/chunk_walk.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/visible_extents.h"
#include "modules/streaminggs/exact_config.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/merge_setting.h"
#include "tests/modules/streaminggs/rtl/rtl_heap.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {
namespace {

constexpr std::uint32_t kChunkGaussians = 8;  // storage.chunk_gaussians of the preset

// In place of ClockedHeap.
class RtlMergeHeap {
 public:
  std::size_t size() const { return is_cleared_ ? 0 : rtl_.size(); }
  std::uint64_t nearest() const { return rtl_.nearest().compared; }
  void insert(std::uint64_t key) { rtl_.insert(with_rest(key)); }
  std::uint64_t take_nearest() {
    const RtlKey key = rtl_.nearest();
    rtl_.delete_nearest();
    return taken(key);
  }
  std::uint64_t take_farthest() {
    const RtlKey key = rtl_.farthest();
    rtl_.delete_farthest();
    return taken(key);
  }
  void clear() {
    is_cleared_ = true;
    rtl_.clear();
  }
  void step() {
    is_cleared_ = false;
    rtl_.step();
  }
  const std::vector<RtlHeapLevel>& levels() const { return rtl_.levels(); }
  std::uint64_t torn() const { return torn_; }  // keys with the rest of another one

 private:
  static RtlKey with_rest(std::uint64_t compared) {
    RtlKey key{compared, {}};
    for (std::uint32_t i = 0; i < key.rest.size(); ++i) {
      key.rest[i] = static_cast<std::uint32_t>(compared * 0x9E3779B97F4A7C15U >> (8 + i));
    }
    return key;
  }
  std::uint64_t taken(const RtlKey& key) {
    torn_ += key == with_rest(key.compared) ? 0 : 1;
    return key.compared;
  }

  RtlHeap rtl_{RtlHeapKind::kOfMerge};
  bool is_cleared_ = false;
  std::uint64_t torn_ = 0;
};

// What comes to the merge unit of the preset `exact`, in exact order: visits until a group is
// finished.
class Recorder {
 public:
  Recorder(const Camera& camera, const GaussianCloud& cloud)
      : view_(make_view<float>(camera)), stored_(by_chunks(activate(cloud), kChunkGaussians)) {}

  tb::MergePlan plan() {
    tb::MergePlan plan;
    plan.sorters = 1;
    plan.slots = static_cast<std::uint32_t>(stored_.cloud.size());
    for (const PixelRect& pixels :
         pixel_groups(view_.width, view_.height, group_of_preset("exact"))) {
      plan.groups.push_back(group(pixels));
    }
    return plan;
  }

 private:
  tb::MergeGroup group(const PixelRect& pixels) {
    tb::MergeGroup out;
    TreeInMemory source{stored_.table, {}};
    ChunkWalk walk(source, ExactConfig{}.vsu.walk_room());
    walk.begin(view_, pixels, stored_.table.nodes.empty());
    GroupState state(pixels, view_.width, view_.height);
    std::set<std::pair<float, std::uint32_t>> waiting;
    std::uint64_t released = 0;
    std::optional<WalkEntry> chunk = walk.next();
    while (chunk && !state.saturated()) {
      tb::MergeVisit visit;
      if (state.any_unfinished(chunk->reach)) visit.keys = keys_of(*chunk, pixels);
      for (const tb::MergeKey& key : visit.keys) waiting.insert({key.depth, key.slot});
      chunk = walk.next();
      if (chunk) visit.release_below = chunk->nearest;
      while (!waiting.empty() && waiting.begin()->first < visit.release_below &&
             !state.saturated()) {
        blend(stored_.cloud.gaussians[waiting.begin()->second], state);
        waiting.erase(waiting.begin());
        ++released;
      }
      out.visits.push_back(visit);
    }
    if (state.saturated()) out.saturates_after = released;
    return out;
  }

  std::vector<tb::MergeKey> keys_of(const WalkEntry& chunk, const PixelRect& pixels) const {
    std::vector<tb::MergeKey> keys;
    for (std::uint32_t slot = chunk.at; slot < chunk.at + chunk.count; ++slot) {
      const Gaussian<float>& g = stored_.cloud.gaussians[slot];
      const VisibleExtents known = decode_extents(encode_extents(visible_extents(g)));
      const ExtentBound bound = extent_bound(view_, g.mean, known.extent, known.scale_max);
      if (bound.in_front && touches(bound, pixels)) keys.push_back({bound.depth, slot});
    }
    std::sort(keys.begin(), keys.end(), [](const tb::MergeKey& a, const tb::MergeKey& b) {
      return key_of(a.depth, a.slot) < key_of(b.depth, b.slot);
    });
    return keys;
  }

  void blend(const Gaussian<float>& g, GroupState& state) const {
    Splat splat{};
    if (make_geometry(view_, g, splat) && reaches_group(splat, state.pixels())) state.blend(splat);
  }

  const View<float> view_;
  const StoredCloud<ChunkTree> stored_;
};

void check(const std::string& name, const MergeSetting& setting) {
  std::vector<HeapLevelWork> charged;
  Takings unit = takings_of_unit(setting.seed, [&](tb::Case& test, Takings& taken) {
    run_merge_unit(test, taken, setting, [&](const MergeUnit& merge) {
      const HeapWork& work = merge.heap_work();
      for (const HeapLevelWork& level : work.levels) {
        taken.push_back({level.nodes_read + level.nodes_read_ahead, level.nodes_written});
      }
      taken.push_back({work.operations(), work.delete_maxs});
    });
  });
  RtlMergeHeap heap;
  const Takings expected = clocked_merge_unit(setting, heap);
  const Taken operations = unit.back();
  REQUIRE(unit.size() == expected.size() + heap.levels().size() + 1);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    differ += unit[i].what == expected[i].what && unit[i].cycle == expected[i].cycle ? 0 : 1;
  }
  for (std::size_t l = 1; l < heap.levels().size(); ++l) {
    const Taken& of_unit = unit[expected.size() + l];
    INFO("level " << l);
    CHECK(heap.levels()[l].nodes_read == of_unit.cycle);
    CHECK(heap.levels()[l].nodes_written == of_unit.what);
  }
  fmt::print(
      "{:24} {:3} groups, {:7} keys out, {:7} operations, {:6} of them at the far end; cycles {:8} "
      "in SystemC, {:8} in Verilog; {} differ\n",
      name, setting.plan.groups.size(), expected.size() - setting.plan.groups.size(),
      operations.cycle, operations.what, unit[expected.size() - 1].cycle, expected.back().cycle,
      differ);
  CHECK(differ == 0);
  CHECK(heap.torn() == 0);
  CHECK(operations.cycle > 0);
}

// Once as fast as keys can leave, once with stalls.
void check_frame(const std::string& name, const Camera& camera, const GaussianCloud& cloud) {
  MergeSetting setting{Recorder(camera, cloud).plan(),
                       {preset_of<ExactConfig>("exact").port, 20, 150}};
  check(name, setting);
  setting.out = {4, 20};
  check(name + ", stalled", setting);
}

void check_shared(const std::string& name) {
  const ViewCameras views = read_view_cameras(shared_path("cameras/" + name + ".json"));
  check_frame(name, scaled_to(views.cameras.front(), 640, 360),
              open_scene(shared_scene(name)).cloud);
}

}  // namespace

TEST_CASE("merge unit with its heap in Verilog: a small frame") {
  const BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=2000");
  check_frame("outdoor", scaled_to(scene.cameras.front(), 110, 62), scene.cloud);
}
TEST_CASE("merge unit with its heap in Verilog: groups that spill") {
  MergeSetting setting;
  setting.port = {preset_of<ExactConfig>("exact").port, 20, 150};
  std::mt19937_64 random(1);
  setting.plan.slots = 4000;
  for (int g = 0; g < 2; ++g) {
    setting.plan.groups.push_back(tb::random_group(random, setting.plan, 8, 100'000));
  }
  setting.plan.groups[0].saturates_after = 900;
  check("random", setting);
}
TEST_CASE("merge unit with its heap in Verilog: truck", "[shared][nightly]") {
  check_shared("truck");
}
TEST_CASE("merge unit with its heap in Verilog: yard", "[shared][nightly]") {
  check_shared("yard");
}

}  // namespace sgs::test

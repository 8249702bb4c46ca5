// The ledger of whole frames, of all machines: what is charged is what the golden renderers count,
// every line is missed when it is not there, and no part or port does more than the frame has time
// for, whatever the configuration.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_renderer.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "testbench/result/ledger.h"
#include "tests/testbench/ledger/simulated_frame.h"

namespace sgs::test {
namespace {

constexpr PixelSize kGroup = {72, 24};
const Settings kPlain = {"storage.encoding=raw", fmt::format("group_width_px={}", kGroup.width),
                         fmt::format("group_height_px={}", kGroup.height),
                         "rendering.saturation_feedback=false"};
// Nothing in it is finished early: what reaches a group late is still needed.
constexpr const char* kSparse = "builtin:object?n=300";

// The parts that both orders share, against a golden renderer's counts. hfus: that share
// a fetch.
void check_shared(const Frame& frame, const StreamingStats& golden, std::uint64_t hfus) {
  REQUIRE(counter(frame, "groups_saturated") == 0);
  CHECK(items(frame, "coarse") == golden.first_halves);
  CHECK(counter(frame, "coarse_tests_of_parts") == hfus * golden.first_halves);
  CHECK(accesses(frame, "input").reads == golden.first_halves);
  CHECK(items(frame, "fine") == golden.fine_tests);
  const std::uint64_t words = (frame.job.layout.second_halves.record_bytes + 31) / 32;
  CHECK(accesses(frame, "second halves").reads == golden.fine_tests * words);
  CHECK(accesses(frame, "second halves").writes == golden.second_halves * words);
  // Beside the pixels that its blends change every sub-tile is cleared once, 16 pixels, and read by
  // rows, 4 at a time. A pixel that a blend finishes is read and not written.
  const std::uint64_t blends = golden.subtile_blends + counter(frame, "subtile_blends_late");
  const SramAccesses pixels = accesses(frame, "pixel state");
  CHECK(pixels.writes == golden.contributors + 72 * 48);
  CHECK(pixels.reads >= pixels.writes);
  CHECK(pixels.reads <= pixels.writes + 72 * 48);
  // What comes before it is known that a sub-tile is finished is looked at for nothing.
  CHECK(accesses(frame, "finished pixels").reads == 16 * blends);
  CHECK(accesses(frame, "finished pixels").writes == pixels.reads - pixels.writes + 72 * 48);
}

TEST_CASE("ledger: exact order is charged with what the golden renderer counts") {
  const Frame frame = simulated("exact", kPlain, kSparse);
  check_paid(frame);
  ExactOrderConfig order;
  order.group = kGroup;
  const ChunkTree& tree = frame.scene->stored.tree();
  const StreamingStats golden =
      render_exact_order(frame.job.view, frame.scene->stored.decoded, tree, order).stats;
  check_shared(frame, golden, 1);
  // Children of the nodes that the walk opens, one by one.
  TreeInMemory source{tree, {}};
  ChunkWalk<TreeInMemory> walk(source, {256, 384});
  for (const PixelRect& group : pixel_groups(72, 48, kGroup)) {
    walk.begin(frame.job.view, group, false);
    while (walk.next()) {
    }
    walk.end();
  }
  const std::uint64_t tests = walk.counters().tests;
  CHECK(walk.counters().nodes == golden.nodes_read);
  CHECK(tests >= 2 * golden.nodes_read);
  CHECK(items(frame, "chunk_test") == tests);
  // Each is put in and taken out, and passes the root and a level below it at most once.
  CHECK(counter(frame, "chunk_queue_operations") == 2 * golden.visits);
  CHECK(counter(frame, "node_queue_operations") == 2 * golden.nodes_read);
  CHECK(accesses(frame, "chunk queue 0").writes == 2 * golden.visits);
  CHECK(accesses(frame, "chunk queue 1").writes > 0);
  CHECK(accesses(frame, "chunk queue 1").writes <= 2 * golden.visits);
  CHECK(accesses(frame, "node queue 0").writes == 2 * golden.nodes_read);
  CHECK(accesses(frame, "node queue 7").writes <= 2 * golden.nodes_read);
  // Every key that the coarse filter passes lies in a sorter, a queue and the heap once.
  CHECK(accesses(frame, "key sorters").reads == golden.coarse_passed);
  CHECK(accesses(frame, "sorted places").reads >= golden.coarse_passed);
  CHECK(accesses(frame, "waiting keys 0").writes >= golden.coarse_passed);
}

// Nothing is finished early: what is tested and fetched follows from both views alone.
TEST_CASE("ledger: two eyes share what is done once, and each is charged with its own") {
  Settings settings = kPlain;
  const Frame left = simulated("exact", settings, kSparse);
  settings.emplace_back("eyes=2");
  const Frame pair = simulated("exact", settings, kSparse);
  check_paid(pair);
  REQUIRE(counter(pair, "groups_saturated") == 0);
  for (const char* once : {"first_halves", "second_halves", "coarse_tests", "released"}) {
    INFO(once);
    CHECK(counter(pair, once) >= counter(left, once));
    CHECK(counter(pair, once) < 1.5 * static_cast<double>(counter(left, once)));
  }
  for (const char* for_each : {"fine_tests", "splats", "subtile_blends"}) {
    INFO(for_each);
    CHECK(counter(pair, for_each) > 1.5 * static_cast<double>(counter(left, for_each)));
  }
  CHECK(accesses(pair, "finished sub-tiles").reads >
        1.5 * static_cast<double>(accesses(left, "finished sub-tiles").reads));
  CHECK(accesses(pair, "pixel state").writes >
        1.5 * static_cast<double>(accesses(left, "pixel state").writes));
  std::map<std::string, std::uint64_t> lanes[2], bits[2];
  for (const Frame* frame : {&left, &pair}) {
    for (const auto& [d, count, busiest] : frame->result.machine.datapaths) {
      lanes[frame == &pair][d.name] += std::uint64_t{d.lanes} * d.copies;
      bits[frame == &pair][d.name] += d.set_bits * d.copies;
    }
  }
  for (const char* doubled :
       {"fine", "conic", "subtile_blend", "spans_begin", "row_span", "drain"}) {
    INFO(doubled);
    CHECK(lanes[1].at(doubled) == 2 * lanes[0].at(doubled));
  }
  for (const char* shared : {"coarse", "chunk_test"}) {
    INFO(shared);
    CHECK(lanes[1].at(shared) == lanes[0].at(shared));
    CHECK(bits[1].at(shared) > bits[0].at(shared));  // the second eye's constants
  }
}

TEST_CASE("ledger: paper order is charged with what the golden renderer counts") {
  Settings settings = kPlain;
  settings.insert(settings.end(),
                  {"vsu.visit_gaussians=0",  // a visit is a voxel
                   "fetch=shared", "hfu.slice_gaussians=512", "sorting.buffer_entries=128"});
  const Frame frame = simulated("paper_no_vq", settings, kSparse);
  check_paid(frame);
  constexpr std::uint32_t kHfus = 4;
  PaperOrderConfig order;
  order.group = kGroup;
  order.parts = kHfus;
  order.precision = BlendPrecision::kHalf;
  order.rays = PaperVsuConfig().rays();
  const StreamingStats golden = render_paper_order(frame.job.view, frame.scene->stored.decoded,
                                                   frame.scene->stored.grid(), order)
                                    .stats;
  check_shared(frame, golden, kHfus);
  CHECK(items(frame, "pixel_ray") == counter(frame, "rays"));
  CHECK(items(frame, "ray_step") + items(frame, "pixel_ray") == golden.ray_steps);
  // Of an edge the voxel that it leads to, where that was met before, the one that it comes from,
  // and the first of its edges, where it has any; a name at least for each end.
  CHECK(accesses(frame, "ordering table").reads >= 2 * golden.edges_offered);
  CHECK(accesses(frame, "renamed voxels").reads >= golden.edges_offered);
  CHECK(accesses(frame, "ready voxels").reads >= golden.visits);
  CHECK(accesses(frame, "ray directions").reads == items(frame, "ray_step"));
  CHECK(accesses(frame, "ordered voxels").reads == golden.visits);
  CHECK(accesses(frame, "sort buffers").reads >= golden.splats);
  CHECK(accesses(frame, "sorted places").reads >= golden.splats);
}

TEST_CASE("ledger: of a real frame, no line can be left out unseen") {
  const Settings groups = {"group_width_px=24", "group_height_px=24"};
  for (const auto& [preset, settings] :
       std::vector<std::pair<std::string, Settings>>{{"exact_vq", groups},
                                                     {"exact_vq", {groups[0], groups[1], "eyes=2"}},
                                                     {"paper", groups},
                                                     {"gscore", {}},
                                                     {"gscore", {"eyes=2"}}}) {
    INFO(preset);
    const Frame frame = simulated(preset, settings, kSparse);
    check_paid(frame);
    const MachineResult& machine = frame.result.machine;
    // Of queues what comes in within a cycle is seen as what goes out is.
    std::size_t queues = 0;
    for (const SramAccesses& a : machine.sram_accesses) {
      INFO(a.use);
      CHECK((a.seen.writes > 0) == (a.seen.reads > 0));
      queues += a.seen.reads > 0 ? 1 : 0;
    }
    CHECK(queues > 5);
    for (std::size_t i = 0; i < machine.sram_accesses.size(); ++i) {
      MachineResult without = machine;
      without.sram_accesses.erase(without.sram_accesses.begin() + static_cast<std::ptrdiff_t>(i));
      CHECK(ledger_faults(without, frame.result.cycles).size() == 1);
    }
    for (const Operations& work : machine.operations) {
      if (work.count == 0) continue;
      INFO(work.component << " " << work.kind);
      MachineResult without = machine;
      without.parts.erase(std::remove_if(without.parts.begin(), without.parts.end(),
                                         [&](const Parts& part) {
                                           return part.component == work.component &&
                                                  part.kind == work.kind;
                                         }),
                          without.parts.end());
      CHECK(ledger_faults(without, frame.result.cycles).size() == 1);
    }
  }
}

// Values that a key may have; one of each is drawn.
using Choices = std::map<std::string, std::vector<std::string>>;

const Choices kShared = {{"hfus", {"1", "2", "4", "6"}},
                         {"sorting_units", {"1", "2", "3"}},
                         {"group_width_px", {"8", "16", "24", "48"}},
                         {"group_height_px", {"8", "16", "24", "48"}},
                         {"hfu.cfus", {"1", "4"}},
                         {"hfu.cfu_lanes", {"1", "4", "60"}},
                         {"hfu.ffu_lanes", {"4", "16", "430"}},
                         {"hfu.cost", {"paper", "counted"}},
                         {"hfu.input_slots", {"2", "5"}},
                         {"hfu.second_half_slots", {"1", "16"}},
                         {"sorting.sort_interval_cycles", {"1", "3"}},
                         {"sorting.merge_interval_cycles", {"1", "2"}},
                         {"rendering.clusters", {"1", "4", "16"}},
                         {"memory_port.max_writes", {"1", "4"}},
                         {"dram.channels", {"1", "4"}},
                         {"codebook.banks", {"1", "8"}},
                         {"sram.shared_bytes", {"0"}},
                         {"sram.input_bytes", {"0"}}};
const Choices kExact = {{"vsu.test_lanes", {"8", "128", "600"}},
                        {"vsu.queue_entries", {"9", "512"}},
                        {"merge.entries", {"16", "300"}},
                        {"merge.on_overflow", {"spill", "blend_early"}}};
const Choices kTwoEyes = {{"eyes", {"2"}}, {"merge.entries", {"16", "300"}}};
const Choices kPaper = {
    {"vsu.rays_in_flight", {"1", "48"}},     {"vsu.chain_entries", {"1", "4"}},
    {"vsu.step_lanes", {"8", "128", "600"}}, {"vsu.table_banks", {"1", "4"}},
    {"vsu.groups_ahead", {"1", "3"}},        {"vsu.table_bytes", {"64", "32768"}},
    {"vsu.visit_gaussians", {"0", "128"}},   {"sorting.buffer_entries", {"16", "256"}}};

Choices with(Choices choices, const Choices& instead) {
  for (const auto& [key, values] : instead) choices[key] = values;
  return choices;
}

const Choices kSplitFetch = with(kPaper, {{"fetch", {"split"}}});
// HFUs that share a fetch are a square number, and share out what is behind them.
const Choices kSharedFetch = with(kPaper, {{"fetch", {"shared"}},
                                           {"hfus", {"1", "4"}},
                                           {"sorting_units", {"1", "2", "4"}},
                                           {"rendering.clusters", {"4", "16"}}});

TEST_CASE("ledger: no part and no port does more than a frame has time for") {
  struct Machine {
    const char* preset;
    const Choices& choices;
    bool codebooks;
  };
  std::mt19937_64 random(11);
  for (const auto& [preset, own, codebooks] :
       {Machine{"exact", kExact, false}, Machine{"exact_vq", kExact, true},
        Machine{"exact", kTwoEyes, false}, Machine{"exact_vq", kTwoEyes, true},
        Machine{"paper", kSplitFetch, true}, Machine{"paper", kSharedFetch, true},
        Machine{"paper_no_vq", kSplitFetch, false}, Machine{"paper_no_vq", kSharedFetch, false}}) {
    for (int repeat = 0; repeat < 8; ++repeat) {
      Settings settings = {"sram.codebook_bytes=256000"};
      std::string all = preset;
      for (const Choices* choices : {&kShared, &own}) {
        for (const auto& [key, values] : *choices) {
          if (!codebooks && key == "codebook.banks") continue;
          settings.push_back(key + "=" + values[random() % values.size()]);
          all += " " + settings.back();
        }
      }
      INFO(all);
      const Frame frame = simulated(preset, settings, "builtin:object?n=900");
      check_paid(frame);
      const auto cycles = static_cast<double>(frame.result.cycles);
      for (const auto& [d, count, busiest] : frame.result.machine.datapaths) {
        INFO(d.name);
        CHECK(static_cast<double>(d.cycles(count)) <= cycles);
      }
      for (const LedgerLine& line : ledger_of(frame.result.machine)) {
        INFO(line.what);
        CHECK(line.done <= line.per_cycle * cycles);
      }
    }
  }
}

}  // namespace
}  // namespace sgs::test

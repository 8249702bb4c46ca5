// Culling and conversion units alone: a scene in memory and passes in, Gaussians with their
// boxes out. Checked against the functions on what the bytes decode to; busy cycles from below.
#include <algorithm>

#include "algorithm/render/tile_renderer.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/ccu/ccu.h"
#include "modules/gscore/gscore_datapaths.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {
namespace {

struct Plan {
  GscoreConfig config;
  SceneShape shape;
  std::uint32_t passes = 1;
};

// By what the first half holds, which in few bits is not less than the largest scale.
bool may_touch(const TestScene& scene, const GscoreJob& job, std::size_t i) {
  const SplitFirstHalf first = read_first_half(
      job.layout.split, scene.image.bytes.data() + job.layout.first_halves.address(i));
  return may_touch_frame(job.view, frame_sides(job.view), first.mean, first.extents.scale_max);
}

// Gaussians that pass the culling of all units, counted beside it.
struct Candidates {
  std::uint64_t there = 0, ends_alone = 0;
  std::uint64_t reads = 0;  // second halves
};

// Neighbours in memory are read at once if they are of a slice and neighbours in the ring of slots.
Candidates candidates_of(const TestScene& scene, const GscoreJob& job, const Plan& plan) {
  Candidates out;
  const CcuConfig& ccu = plan.config.ccu;
  const std::size_t size = ccu.slice_gaussians, count = scene.cloud.size();
  std::vector<std::uint64_t> taken(plan.config.ccus);  // slots of each unit's ring
  for (std::uint32_t p = 0; p < plan.passes; ++p) {
    for (std::size_t s = 0; s * size < count; ++s) {
      std::uint64_t& slot = taken[s % plan.config.ccus];
      bool neighbour = false;
      for (std::size_t i = s * size; i < std::min(count, (s + 1) * size); ++i) {
        const bool there = may_touch(scene, job, i);
        if (there) {
          ++out.there;
          out.reads += neighbour && slot % ccu.second_half_slots != 0 ? 0 : 1;
          ++slot;
        }
        neighbour = there;
      }
      out.ends_alone += neighbour ? 0 : 1;
    }
  }
  return out;
}

// The expected output for one slice.
std::vector<Converted> expected_of(const TestScene& scene, const GscoreJob& job,
                                   const GscoreConfig& config, std::size_t first, std::size_t end) {
  std::vector<Converted> out;
  const ActivatedCloud& cloud = scene.cloud;
  const FrameSides<float> sides = frame_sides(job.view);
  for (std::size_t i = first; i < end; ++i) {
    const auto& g = cloud.gaussians[i];
    Converted made;
    made.last = i + 1 == end;
    made.end_of_pass = i + 1 == cloud.size();
    const float scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
    made.there = may_touch_frame(job.view, sides, g.mean, scale_max) &&
                 make_tile_geometry(job.view, g, config.tiles.rules(), made.splat, made.boxes);
    if (made.there) add_colour(job.view, cloud.sh_degree, g.mean, cloud.sh(i), made.splat);
    if (made.there || made.last) out.push_back(made);
  }
  return out;
}

bool same(const Converted& a, const Converted& b) {
  if (a.there != b.there || a.last != b.last || a.end_of_pass != b.end_of_pass) return false;
  if (!a.there) return true;
  const Splat &s = a.splat, &r = b.splat;
  const TileBoxes &p = a.boxes, &q = b.boxes;
  return s.x == r.x && s.y == r.y && s.depth == r.depth && s.conic_a == r.conic_a &&
         s.conic_b == r.conic_b && s.conic_c == r.conic_c && s.opacity == r.opacity &&
         s.rgb == r.rgb && p.tiles.x0 == q.tiles.x0 && p.tiles.y1 == q.tiles.y1 &&
         p.parts.x1 == q.parts.x1 && p.box.used == q.box.used &&
         p.box.half_long == q.box.half_long && p.box.axis_x == q.box.axis_x;
}

void run_plan(Case& test, const BenchConfig& bench_config, Plan plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  GscoreConfig& config = plan.config;
  plan.shape.order = StorageOrder::kFile;
  const TestScene scene = random_scene(test.random, plan.shape);
  FrameJob frame = scene.job;
  frame.layout = scene.image.layout;
  const GscoreJob job = gscore_frame(config, bench, frame);
  bench.load(0, scene.image.bytes);
  auto passes = bench.add_fifos<Pass>("passes", config.ccus, 1, 1);
  auto converted = bench.add_fifos<Converted>("converted", config.ccus, 4, 1);
  gscore::Phases phases;
  std::vector<std::unique_ptr<Ccu>> units;
  for (std::uint32_t c = 0; c < config.ccus; ++c) {
    units.push_back(std::make_unique<Ccu>(fmt::format("ccu{}", c).c_str(), c,
                                          gscore::UnitContext{bench.clock(), job, config, phases}));
    units[c]->passes(*passes[c]);
    units[c]->converted(*converted[c]);
    bench.add_unit(*units[c]);
  }
  phases.projecting.begin();
  std::uint64_t got = 0;
  bench.add_thread("lister", [&](Activity& activity) {
    const std::size_t size = config.ccu.slice_gaussians, count = scene.cloud.size();
    for (std::uint32_t p = 0; p < plan.passes; ++p) {
      for (auto* fifo : passes) fifo->push({0, job.tile_count, false}, activity);
      for (std::size_t s = 0; s * size < count; ++s) {
        const auto expected =
            expected_of(scene, job, config, s * size, std::min(count, (s + 1) * size));
        for (const Converted& one : expected) {
          const Converted next = converted[s % config.ccus]->pop(activity);
          checks.that(same(next, one), fmt::format("a Gaussian of slice {}", s));
          got += next.there ? 1 : 0;
        }
      }
    }
    Pass over;
    over.over = true;
    for (auto* fifo : passes) fifo->push(over, activity);
  });
  bench.run();

  const std::uint64_t count = scene.cloud.size();
  checks.equal(bench.counter("converted") - bench.counter("unseen"), got, "handed on");
  bench.check_counter("first_halves", count * plan.passes);
  checks.equal(bench.counter("culled") + bench.counter("second_halves"), count * plan.passes,
               "culled and fetched");
  bench.check_counter("converted", bench.counter("second_halves"));
  checks.equal(
      bench.bytes_read(),
      std::uint64_t{job.layout.first_halves.record_bytes} * count * plan.passes +
          std::uint64_t{job.layout.second_halves.record_bytes} * bench.counter("second_halves"),
      "bytes read");
  const Candidates candidates = candidates_of(scene, job, plan);
  bench.check_counter("second_halves", candidates.there);
  bench.check_counter("runs", candidates.reads);
  bench.check_accesses("first halves", count * plan.passes, count * plan.passes);
  const std::uint64_t words =
      candidates.there * cycles_for(job.layout.second_halves.record_bytes, kPortBytes);
  bench.check_accesses("second halves", words, words);
  // The end of a slice passes by itself if its last Gaussian does not; one of the scene, each unit.
  const std::uint64_t gathered = candidates.there + candidates.ends_alone + config.ccus;
  bench.check_accesses("candidates of a slice", gathered, gathered);
  if (config.ccus > 1) return;
  const std::uint64_t slices = cycles_for(count, config.ccu.slice_gaussians) * plan.passes;
  checks.equal(bench.busy_cycles("ccu load"), slices, "cycles of loading");
  // A cycle to gather and one to hand on.
  checks.equal(bench.busy_cycles("ccu fetch"), 2 * gathered, "cycles of fetching");
  // Each datapath begins an item in its turns.
  const auto bound = [&](const char* resource, std::uint64_t items, const Datapath& path) {
    checks.that(bench.busy_cycles(resource) >= items * path.interval_cycles(),
                std::string(resource) + ": bound");
  };
  bound("ccu cull", bench.counter("first_halves"), cull_pipeline(config));
  bound("ccu convert", bench.counter("converted"),
        convert_pipeline(config, job.layout.sh_degree()));
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan;
  plan.config = random_gscore(random);
  plan.config.ccus = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.config.ccu.slice_gaussians = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.config.ccu.input_slots = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.config.ccu.second_half_slots = 1 + static_cast<std::uint32_t>(random() % 8);
  plan.shape = random_shape(random);
  if (random() % 3 == 0) plan.shape.encoding = SecondHalfEncoding::kHalf;
  plan.passes = 1 + static_cast<std::uint32_t>(random() % 3);
  run_plan(test, random_bench(random, kGscoreMemoryBytes), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_ccu", "Culling and conversion units alone");
  const auto directed = [&](const char* name, std::size_t gaussians, int degree, std::uint32_t ccus,
                            std::uint32_t passes) {
    runner.add_directed(name, [=](Case& test) {
      Plan plan;
      plan.config.ccus = ccus;
      plan.config.lists.pool_bytes = 1 << 20;
      plan.shape.gaussians = gaussians;
      plan.shape.sh_degree = degree;
      plan.passes = passes;
      run_plan(test, still_bench(kGscoreMemoryBytes), plan);
    });
  };
  directed("empty scene", 0, 0, 1, 1);
  directed("one Gaussian, four CCUs", 1, 0, 4, 1);
  directed("degree 0", 300, 0, 1, 1);
  directed("degree 3", 300, 3, 1, 1);
  directed("four CCUs", 500, 1, 4, 1);
  directed("several passes", 300, 1, 2, 3);
  runner.set_random(random_case);
  return runner.run(argc, argv);
}

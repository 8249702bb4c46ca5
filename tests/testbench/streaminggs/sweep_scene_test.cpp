// The scene of sweep_task.h: what a scene makes once for all points.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/ply_writer.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/machines.h"
#include "testbench/streaminggs/run/recently_used.h"
#include "testbench/streaminggs/sweep/sweep_task.h"
#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

RunConfig config_with(const std::vector<std::string>& overrides) {
  ConfigDocument document;
  for (const std::string& assignment : overrides) document.add_override(assignment);
  return read_run_config(document, machine_kinds());
}

SceneArguments small_scene() {
  SceneArguments arguments;
  arguments.scene = "builtin:object?n=300";
  return arguments;
}

TEST_CASE("sweep scene: codebooks are made once, however their indices are stored") {
  SweepScene scene(small_scene());
  int iterations = 0;
  const auto prepared = [&](const std::vector<std::string>& overrides) {
    RunConfig config = config_with(overrides);
    scene.resolve(config, "");
    return scene.prepared(config, [&](Codebook, std::uint32_t, double) { ++iterations; });
  };
  const std::string few = "storage.vq.sh_entries=16";
  const PreparedScene first = prepared({"storage.encoding=vq", few});
  const int of_first = iterations;
  CHECK(of_first > 0);
  prepared({"storage.encoding=vq_packed", few});
  prepared({"machine=paper", "storage.encoding=vq", "storage.voxel_size=1", few});
  CHECK(iterations == of_first);
  prepared({"storage.encoding=vq", "storage.vq.sh_entries=8"});
  CHECK(iterations > of_first);
  // The bytes are those of a scene that is stored alone.
  RunConfig config = config_with({"storage.encoding=vq", "sram.codebook_bytes=65536", few});
  resolve(config);
  const Scene alone = small_scene().load();
  const std::vector<Camera> cameras = alone.cameras;
  CHECK((prepare(alone, config, cameras).stored.image.bytes == first.stored.image.bytes));
}

TEST_CASE("sweep scene: one key for what is stored alike") {
  SweepScene scene(small_scene());
  const auto key = [&](const std::vector<std::string>& overrides) {
    RunConfig config = config_with(overrides);
    scene.resolve(config, "");
    return scene.storage_key(config);
  };
  const std::string base = key({});
  CHECK(key({"hfus=2", "group_width_px=32"}) == base);
  for (const char* other : {"storage.chunk_gaussians=4", "storage.encoding=half", "machine=gscore",
                            "storage.store_invisible=true"}) {
    INFO(other);
    CHECK(key({other}) != base);
  }
}

TEST_CASE("sweep scene: the digest is of the file and of how it is read") {
  const test::ScratchFolder scratch;
  SceneArguments arguments;
  arguments.scene = scratch.path("a.ply");
  write_ply(arguments.scene, small_scene().load().cloud);
  const std::uint64_t plain = SweepScene(arguments).digest();
  scratch.write("b.ply", "x");
  CHECK(SweepScene(arguments).digest() == plain);
  arguments.axes = "rub";
  CHECK(SweepScene(arguments).digest() != plain);
}

struct Block {
  int value;
};
std::uint64_t size_bytes(const Block&) { return 10; }

TEST_CASE("recently used: what was wanted last stays, as far as there is room") {
  RecentlyUsed<Block> blocks(25);
  int made = 0;
  const auto get = [&](const char* key) {
    return blocks.get(key, [&] { return Block{++made}; })->value;
  };
  CHECK(get("a") == 1);
  CHECK(get("b") == 2);
  CHECK(get("a") == 1);
  CHECK(get("c") == 3);  // in the place of b
  CHECK(get("a") == 1);
  CHECK(get("b") == 4);
  RecentlyUsed<Block> none(0);
  CHECK(none.get("a", [] { return Block{5}; })->value == 5);
  CHECK(none.get("a", [] { return Block{6}; })->value == 5);
}

}  // namespace
}  // namespace sgs

// Every form: cut at any byte it is refused, with any byte changed it is read or refused, and no
// count makes room for what the file cannot hold.
#include <catch2/catch.hpp>
#include <functional>

#include "algorithm/scene_files/load_scene.h"
#include "testbench/builtin/random.h"
#include "tests/algorithm/scene/ply_bytes.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;

namespace {

// Records between other elements.
std::string plain_ply(const char* format, const char* line_end) {
  test::PlyTable table = test::counting_table(3, 9);
  table.format = format;
  table.line_end = line_end;
  table.header_before = "comment x\nelement face 1\nproperty list uchar int corners\n";
  table.body_before = test::encoded(format, "uchar", 2) + test::encoded(format, "int", 1) +
                      test::encoded(format, "int", 2);
  table.header_after = "element tail 1\nproperty float w\n";
  table.body_after = test::encoded(format, "float", 1);
  if (table.format == "ascii") {
    table.body_before += line_end;
    table.body_after += line_end;
  }
  return test::bytes_of(table);
}

struct MadeFile {
  const char* name;
  std::function<std::string()> bytes;
  std::size_t step;  // between cuts
};

const MadeFile kFiles[] = {
    {"a.splat", [] { return test::splat_bytes(3); }, 1},
    {"1.ply", [] { return plain_ply("ascii", "\n"); }, 1},
    {"2.ply", [] { return plain_ply("ascii", "\r\n"); }, 1},
    {"3.ply", [] { return plain_ply("binary_little_endian", "\r\n"); }, 1},
    {"4.ply", [] { return plain_ply("binary_big_endian", "\n"); }, 1},
    {"a.ply", [] { return test::compressed_ply_bytes(3, 1, true); }, 1},
    {"1.spz", [] { return test::spz_bytes(1, 3, 1); }, 1},
    {"2.spz", [] { return test::spz_bytes(2, 3, 1); }, 1},
    {"3.spz", [] { return test::bare_spz_bytes(3, 3, 1); }, 1},
    {"4.spz", [] { return test::spz_bytes(4, 3, 1); }, 1},
    {"a.sog", [] { return test::zip_bytes(test::sog_parts(3, 1)); }, 7},
    {"0.ksplat", [] { return test::ksplat_bytes(0, 5, 1); }, 11},
    {"1.ksplat", [] { return test::ksplat_bytes(1, 5, 1); }, 11},
    {"a.glb", [] { return test::glb_bytes(2, 1); }, 3},
    {"b.glb", [] { return test::spz_glb_bytes(test::spz_bytes(2, 3, 1)); }, 1},
};

}  // namespace

TEST_CASE("scene files refuse: one that is cut anywhere") {
  const test::ScratchFolder scratch;
  for (const MadeFile& file : kFiles) {
    const std::string whole = file.bytes();
    REQUIRE(load_scene(scratch.write(file.name, whole)).cloud.size() > 1);
    for (std::size_t size = 0; size < whole.size(); size += file.step) {
      CAPTURE(file.name, size, whole.size());
      // Records without a header: whole ones are a scene.
      if (std::string(file.name) == "a.splat" && size > 0 && size % 32 == 0) continue;
      const std::string path = scratch.write(file.name, whole.substr(0, size));
      REQUIRE_THROWS_AS(load_scene(path), InputError);
    }
  }
}

TEST_CASE("scene files: damaged bytes are read or refused, nothing else") {
  const test::ScratchFolder scratch;
  Random random(7);
  for (const MadeFile& file : kFiles) {
    const std::string whole = file.bytes();
    for (int round = 0; round < 300; ++round) {
      std::string damaged = whole;
      for (std::uint64_t k = random.bits() % 3 + 1; k > 0; --k) {
        damaged[random.bits() % damaged.size()] = static_cast<char>(random.bits());
      }
      try {
        load_scene(scratch.write(file.name, damaged), {round % 2 == 0});
      } catch (const InputError&) {
      }
    }
  }
}

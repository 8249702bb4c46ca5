// What is taken out of the folder is what was put in, and nothing else ever is.
#include "testbench/streaminggs/run/codebook_cache.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/vq/small_config.h"
#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

struct Kept {
  test::ScratchFolder scratch;
  std::string folder = scratch.path("cache/below");
  ActivatedCloud cloud = activate(test::random_cloud(1, 400, 2, {0, 0, 0}, 3, 0.01F, 1));
  VqConfig config = test::small_config();
  std::vector<Camera> cameras = {test::forward_camera(48, 32, 60)};
  int made = 0;

  QuantisedCloud get() {
    return CodebookCache(folder).codebooks(cloud, config, cameras, [&] {
      ++made;
      const std::vector<float> even(cloud.size(), 1.0F), sizes(cloud.size(), 0.01F);
      return quantise(cloud, even, sizes, config);
    });
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    for (const auto& file : fs::directory_iterator(folder)) all.push_back(file.path());
    return all;
  }
};

bool same(const QuantisedCloud& a, const QuantisedCloud& b) {
  return a.codebooks == b.codebooks && a.indices == b.indices && a.opacities == b.opacities;
}

TEST_CASE("codebook cache: made once, the same to the bit afterwards") {
  for (const int degree : {0, 1, 2, 3}) {
    Kept kept;
    kept.cloud = activate(test::random_cloud(1, 400, degree, {0, 0, 0}, 3, 0.01F, 1));
    kept.cloud.gaussians[7].opacity = 0.001F;  // no view can show it
    const QuantisedCloud first = kept.get();
    CHECK(same(kept.get(), first));
    CHECK(kept.made == 1);
    CHECK(kept.files().size() == 1);
  }
  Kept single;  // a codebook of one entry has no index
  single.config.scale_entries = 1;
  const QuantisedCloud first = single.get();
  CHECK(same(single.get(), first));
  CHECK(single.made == 1);
}

TEST_CASE("codebook cache: whatever they follow from makes other ones") {
  Kept kept;
  kept.get();
  int expected = 1;
  const auto check_made = [&] {
    kept.get();
    CHECK(kept.made == ++expected);
    kept.get();
    CHECK(kept.made == expected);
  };
  kept.config.seed += 1;
  check_made();
  kept.config.dc_entries += 1;
  check_made();
  kept.cameras[0].focal_x += 1e-9;
  check_made();
  kept.cameras.push_back(kept.cameras[0]);
  check_made();
  kept.cloud.gaussians[3].quat[1] += 1e-6F;
  check_made();
  kept.cloud.sh_coeffs[5].y += 1e-6F;
  check_made();
}

TEST_CASE("codebook cache: a damaged entry is made anew") {
  Kept kept;
  const QuantisedCloud first = kept.get();
  const fs::path entry = kept.files().front();
  const auto bytes = fs::file_size(entry);
  const auto damages = {
      +[](const fs::path& file, std::uintmax_t size) { fs::resize_file(file, size / 2); },
      +[](const fs::path& file, std::uintmax_t) { fs::resize_file(file, 0); },
      +[](const fs::path& file, std::uintmax_t size) {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(size / 2));
        stream.put('\x5a').put('\xa5').put('\x5a');
      }};
  int expected = 1;
  for (const auto& damage : damages) {
    damage(entry, bytes);
    CHECK(same(kept.get(), first));
    CHECK(kept.made == ++expected);
    CHECK(same(kept.get(), first));
    CHECK(kept.made == expected);
  }
  // Of another scene, or of the same one with another seed, under this name.
  Kept others[2];
  others[0].cloud = activate(test::random_cloud(2, 300, 2, {0, 0, 0}, 3, 0.01F, 1));
  others[1].config.seed += 1;
  for (Kept& other : others) {
    CHECK_FALSE(same(other.get(), first));
    fs::copy_file(other.files().front(), entry, fs::copy_options::overwrite_existing);
    CHECK(same(kept.get(), first));
    CHECK(kept.made == ++expected);
  }
}

TEST_CASE("codebook cache: what cannot be kept is made all the same") {
  Kept kept;
  kept.folder = kept.scratch.path("a_file");
  std::ofstream(kept.folder) << "no folder";
  kept.get();
  kept.get();
  CHECK(kept.made == 2);
  kept.folder = CodebookCache::kOff;
  kept.get();
  CHECK(kept.made == 3);
  CHECK_FALSE(fs::exists(CodebookCache::kOff));
  kept.folder = "";  // as tests have it: off
  kept.get();
  CHECK(kept.made == 4);
}

TEST_CASE("codebook cache: the oldest give way beyond the most bytes, other files stay") {
  Kept kept;
  kept.get();
  const fs::path entry = kept.files().front(), folder = kept.folder;
  const auto put = [&](const char* name, std::uintmax_t bytes, int hours) {
    std::ofstream(folder / name).close();
    fs::resize_file(folder / name, bytes);  // without a block of the disk
    fs::last_write_time(folder / name,
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  const char *old = "codebooks-00000000000000a1.sgs", *oldest = "codebooks-00000000000000a3.sgs",
             *part = "codebooks-00000000000000a2.sgs.17-0.part";  // of a process that was killed
  put(old, 1 << 20, 3);
  put(part, CodebookCache::kMostBytes - (1 << 20), 4);
  put(oldest, 1, 5);
  put("codebooks-garden.sgs", 1 << 20, 6);  // the user's
  fs::remove(entry);
  kept.get();
  CHECK(fs::exists(entry));
  CHECK(fs::exists(folder / old));
  CHECK_FALSE(fs::exists(folder / part));
  CHECK_FALSE(fs::exists(folder / oldest));
  CHECK(fs::exists(folder / "codebooks-garden.sgs"));
}

}  // namespace
}  // namespace sgs

// Writer to reader and back, bit for bit.
#include "algorithm/scene/ply_writer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_reader.h"
#include "testbench/builtin/random.h"
#include "tests/algorithm/scene/ply_bytes.h"
#include "tests/support/same_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using sgs::test::same_bytes;

namespace {

GaussianCloud random_cloud(std::size_t count, int degree) {
  Random random(static_cast<std::uint64_t>(degree) + 1);
  const auto value = [&random] { return static_cast<float>(random.normal() * 10); };
  GaussianCloud cloud;
  cloud.resize(count, degree);
  for (auto& mean : cloud.means) mean = {value(), value(), value()};
  const auto log_scale = [&value] { return -std::abs(value()); };
  for (auto& scale : cloud.log_scales) scale = {log_scale(), log_scale(), log_scale()};
  for (auto& quat : cloud.quats) quat = {value(), value(), value(), value()};
  for (auto& logit : cloud.opacity_logits) logit = value();
  for (auto& coeff : cloud.sh_coeffs) coeff = {value(), value(), value()};
  return cloud;
}

}  // namespace

TEST_CASE("ply writer: what is read back has the same bits, at every degree") {
  const test::ScratchFolder scratch;
  for (int degree = 0; degree <= 3; ++degree) {
    GaussianCloud cloud = random_cloud(20'001, degree);  // more than one block
    cloud.means[0] = {-0.0f, std::numeric_limits<float>::denorm_min(),
                      static_cast<float>(kMaxCoordinate)};
    write_ply(scratch.path("a.ply"), cloud);
    const GaussianCloud back = read_ply(scratch.path("a.ply")).cloud;
    CHECK(back.sh_degree == degree);
    CHECK(same_bytes(back.means, cloud.means));
    CHECK(same_bytes(back.log_scales, cloud.log_scales));
    CHECK(same_bytes(back.quats, cloud.quats));
    CHECK(same_bytes(back.opacity_logits, cloud.opacity_logits));
    CHECK(same_bytes(back.sh_coeffs, cloud.sh_coeffs));
  }
  CHECK(scratch.file_count() == 1);  // no temporaries left
}

TEST_CASE("ply writer: the file is the original's, byte for byte") {
  const test::ScratchFolder scratch;
  test::PlyTable table;
  table.columns = test::inria_columns(9);
  table.rows = test::counting_rows(2, table.columns.size());
  for (auto& row : table.rows) row[3] = row[4] = row[5] = 0;  // normals
  const std::string bytes = test::bytes_of(table);
  write_ply(scratch.path("b.ply"), read_ply(scratch.write("a.ply", bytes)).cloud);
  CHECK(test::bytes_of(scratch.path("b.ply")) == bytes);
}

TEST_CASE("ply writer: what is noted of an anti-aliased scene is noted of the file") {
  const test::ScratchFolder scratch;
  const GaussianCloud cloud = random_cloud(3, 1);
  write_ply(scratch.path("a.ply"), cloud, {"a word", kAntialiasedNote});
  const SceneContents back = read_ply(scratch.path("a.ply"));
  CHECK(back.notes == std::vector<std::string>{kAntialiasedNote});
  CHECK(same_bytes(back.cloud.means, cloud.means));
  write_ply(scratch.path("a.ply"), cloud, {"a word"});
  CHECK(read_ply(scratch.path("a.ply")).notes.empty());
}

TEST_CASE("ply writer: bad targets and bad clouds leave nothing behind") {
  const test::ScratchFolder scratch;
  GaussianCloud cloud = random_cloud(3, 1);
  scratch.write("file", "");
  test::input_error_of([&] { write_ply(scratch.path("file/a.ply"), cloud); });
  test::input_error_of([&] { write_ply(scratch.path(""), cloud); });
  cloud.quats.pop_back();
  test::input_error_of([&] { write_ply(scratch.path("a.ply"), cloud); });
  CHECK(scratch.file_count() == 1);
}

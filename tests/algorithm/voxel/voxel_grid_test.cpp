// The sparse voxel tree: every visible Gaussian in the voxel of its centre, nothing else.
#include "algorithm/voxel/voxel_grid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>
#include <string>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

Gaussian<float> at(float x, float y, float z, float opacity = 0.9F) {
  return {{x, y, z}, glm::vec3(0.1F), {1, 0, 0, 0}, opacity};
}

ActivatedCloud random_cloud(unsigned seed, std::size_t count, float half_side) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> along(-half_side, half_side), opacity(0.0F, 0.02F);
  ActivatedCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.gaussians.push_back(at(along(random), along(random), along(random), opacity(random)));
  }
  cloud.sh_coeffs.resize(count);
  return cloud;
}

// Local cell of a voxel, found by descending the tree from the root; fails where it is not in it.
std::map<std::uint32_t, glm::ivec3> cells_in_tree(const VoxelGrid& grid) {
  std::map<std::uint32_t, glm::ivec3> found;
  struct Entry {
    std::uint32_t index;
    int level;
    glm::ivec3 corner;
  };
  std::vector<Entry> open;
  if (!grid.nodes.empty()) open.push_back({0, grid.frame.levels, glm::ivec3(0)});
  while (!open.empty()) {
    const Entry entry = open.back();
    open.pop_back();
    const VoxelNode& node = grid.nodes[entry.index];
    std::uint32_t child = node.first_child;
    const int side = 1 << (2 * (entry.level - 1));
    for (unsigned bit = 0; bit < 64; ++bit) {
      if ((node.occupied >> bit & 1U) == 0) continue;
      // Bits of a Morton number, taken apart here: x is 0 and 3, y 1 and 4, z 2 and 5.
      const auto part = [&](unsigned low) {
        return static_cast<int>((bit >> low & 1U) | (bit >> (low + 3) & 1U) << 1U);
      };
      const glm::ivec3 corner = entry.corner + glm::ivec3(part(0), part(1), part(2)) * side;
      if (entry.level == 1) {
        REQUIRE(found.emplace(child, corner).second);
      } else {
        open.push_back({child, entry.level - 1, corner});
      }
      ++child;
    }
  }
  return found;
}

void check_grid(const ActivatedCloud& cloud, const Arrangement<VoxelGrid>& arrangement,
                Stored stored) {
  const VoxelGrid& grid = arrangement.table;
  const std::vector<std::uint32_t>& storage_order = arrangement.storage_order;
  const auto cells = cells_in_tree(grid);
  REQUIRE(cells.size() == grid.voxels.size());
  std::set<std::uint32_t> seen;
  std::uint32_t slot = 0;
  for (const auto& [voxel, cell] : cells) {
    const VoxelRecord& record = grid.voxels[voxel];
    REQUIRE(record.first == slot);  // contiguous, in the order of ids
    REQUIRE(record.count > 0);
    for (; slot < record.first + record.count; ++slot) {
      const std::uint32_t index = storage_order[slot];
      REQUIRE(seen.insert(index).second);
      if (slot > record.first && record.count <= kLeastCut) {
        REQUIRE(index > storage_order[slot - 1]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double place = static_cast<double>(cloud.gaussians[index].mean[axis]) /
                             static_cast<double>(grid.frame.voxel_size);
        REQUIRE(std::floor(place) == cell[axis] + grid.frame.origin_cell[axis]);
      }
    }
  }
  REQUIRE(slot == storage_order.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const bool visible = cloud.gaussians[i].opacity >= 1.0F / 255;
    REQUIRE(seen.count(i) == (visible || stored == Stored::kAll ? 1U : 0U));
  }
}

TEST_CASE("voxel grid: every visible Gaussian in the voxel of its centre") {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const float voxel_size : {0.05F, 0.4F, 2.0F, 100.0F}) {
      const ActivatedCloud cloud = random_cloud(seed, 500, 5);
      check_grid(cloud, arrange_by_voxels(cloud, voxel_size), Stored::kVisible);
      check_grid(cloud, arrange_by_voxels(cloud, voxel_size, Stored::kAll), Stored::kAll);
    }
  }
}

// Every piece of `most` or fewer; a box in front of another on an axis is visited before it by an
// eye in front of the plane between them.
void check_pieces(const ActivatedCloud& cloud, const Arrangement<VoxelGrid>& arrangement,
                  const glm::vec3& eye, std::uint32_t most) {
  const VoxelGrid& grid = arrangement.table;
  const std::vector<std::uint32_t>& storage_order = arrangement.storage_order;
  for (const VoxelRecord& voxel : grid.voxels) {
    std::vector<VoxelRecord> pieces;
    const auto plane = [&](std::uint32_t index) { return grid.cuts[index]; };
    visit_pieces(voxel, eye, most, plane, [&](const VoxelRecord& piece) {
      pieces.push_back(piece);
      return true;
    });
    std::set<std::uint32_t> slots;
    struct Box {
      glm::vec3 low, high;
    };
    std::vector<Box> boxes;
    for (const VoxelRecord& piece : pieces) {
      CHECK(piece.count <= std::max(most, kLeastCut));
      Box box{cloud.gaussians[storage_order[piece.first]].mean, {}};
      box.high = box.low;
      for (std::uint32_t slot = piece.first; slot < piece.first + piece.count; ++slot) {
        CHECK(slots.insert(slot).second);
        for (int axis = 0; axis < 3; ++axis) {
          const float at = cloud.gaussians[storage_order[slot]].mean[axis];
          box.low[axis] = std::min(box.low[axis], at);
          box.high[axis] = std::max(box.high[axis], at);
        }
      }
      boxes.push_back(box);
    }
    CHECK(slots.size() == voxel.count);
    if (!slots.empty()) CHECK(*slots.begin() == voxel.first);
    // Some axis parts each pair, and the eye is not on the far side of all that do.
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a + 1; b < boxes.size(); ++b) {
        bool right = false;
        for (int axis = 0; axis < 3; ++axis) {
          right = right ||
                  (boxes[a].high[axis] <= boxes[b].low[axis] && eye[axis] <= boxes[b].low[axis]);
          right = right ||
                  (boxes[b].high[axis] <= boxes[a].low[axis] && eye[axis] >= boxes[b].high[axis]);
        }
        CHECK(right);
      }
    }
  }
}

TEST_CASE("voxel grid: pieces of voxels are boxes, the nearest first") {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const ActivatedCloud cloud = random_cloud(seed, 3000, 5);
    for (const float voxel_size : {1.0F, 100.0F}) {
      const Arrangement<VoxelGrid> arrangement = arrange_by_voxels(cloud, voxel_size);
      for (const std::uint32_t most : {1U, 64U, 128U, 500U}) {
        check_pieces(cloud, arrangement, {0.1F, -0.3F, 0.2F}, most);
        check_pieces(cloud, arrangement, {9, -20, 3}, most);
      }
    }
  }
}

TEST_CASE("voxel grid: Gaussians in one place are cut all the same") {
  ActivatedCloud cloud;
  cloud.gaussians.assign(1000, at(0.5F, 0.5F, 0.5F));
  const Arrangement<VoxelGrid> arrangement = arrange_by_voxels(cloud, 1.0F);
  REQUIRE(arrangement.table.voxels.size() == 1);
  check_pieces(cloud, arrangement, {0, 0, 0}, 64);
}

TEST_CASE("voxel grid: nothing is sized by the dense grid") {
  ActivatedCloud cloud;
  cloud.gaussians = {at(-5e5F, 0, 0), at(5e5F, 1e5F, -3e5F), at(0.25F, 0.25F, 0.25F)};
  const Arrangement<VoxelGrid> arrangement = arrange_by_voxels(cloud, 1.0F);
  const VoxelGrid& grid = arrangement.table;
  CHECK(grid.frame.levels == 10);
  CHECK(grid.voxels.size() == 3);
  CHECK(grid.nodes.size() <= 30);  // ten levels for each
  check_grid(cloud, arrangement, Stored::kVisible);
}

TEST_CASE("voxel grid: a million cells an axis at most, and the message says what fits") {
  ActivatedCloud cloud;
  cloud.gaussians = {at(0, 0, 0), at(1048576, 0, 0)};
  std::string message;
  try {
    arrange_by_voxels(cloud, 0.5F);
  } catch (const InputError& error) {
    message = error.what();
  }
  CHECK(message.find("voxel_size: 0.5") != std::string::npos);
  CHECK(message.find("at least 1") != std::string::npos);
  CHECK_NOTHROW(arrange_by_voxels(cloud, 1.01F));
}

TEST_CASE("voxel grid: a centre on a face belongs to the cell above it") {
  CHECK(cell_of(2.0F, 0.5F) == 4);
  CHECK(cell_of(-2.0F, 0.5F) == -4);
  CHECK(cell_of(-0.1F, 0.5F) == -1);
  CHECK(cell_of(0.0F, 0.5F) == 0);
}

TEST_CASE("voxel grid: the paper's voxel sizes, outliers aside") {
  ActivatedCloud small = random_cloud(1, 5000, 4.9F);
  small.gaussians[17].mean.x = 1e6F;  // one of 5000 is below 0.1 %
  CHECK(inner_extent(small) == Approx(9.8).epsilon(0.01));
  CHECK(paper_voxel_size(inner_extent(small)) == 0.4);
  CHECK(paper_voxel_size(inner_extent(random_cloud(2, 5000, 5.1F))) == 2);
  CHECK(inner_extent({}) == 0);
  CHECK(paper_voxel_size(0) == 0.4);
  CHECK(paper_voxel_size(10) == 0.4);
  CHECK(paper_voxel_size(std::nextafter(10.0F, 11.0F)) == 2);
}

}  // namespace
}  // namespace sgs

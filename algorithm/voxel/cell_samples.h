// Samples of a pixel's ray at a fixed distance, each with the cell that its coordinate lies in. The
// voxel sorting unit of StreamingGS (DAC 2025) numbers voxels so: no sample waits for the one
// before it. Sampling can miss the corner of a cell.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>

#include "algorithm/splat/scalar.h"
#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Cells a side of the box that all voxels lie in; its corner is the root's.
glm::ivec3 occupied_cells(const VoxelGrid& grid);

// Numbers of a frame: lengths in cells, places from the corner of the box.
template <class T>
struct SampleSpaceOf {
  glm::vec<3, T> eye;
  glm::vec<3, T> box;
  T step;  // distance of samples
  T far;   // a ray's end, in samples from the eye
};
using SampleSpace = SampleSpaceOf<float>;

// far_voxels: where rays end; 0: with the box. Throws InputError where a ray may have more samples
// than have numbers.
SampleSpace sample_space(const glm::vec3& eye, const VoxelFrame& frame, const glm::ivec3& cells,
                         float step_voxels, float far_voxels);

// The samples of one ray in the box, the nearest first. Rounding keeps each coordinate monotonic
// along the ray, so that Manhattan distance from the eye's cell rises from cell to cell, and no two
// rays disagree about the order of two cells.
template <class T = float>
class CellSamples {
 public:
  using Index = IndexOf<T>;

  explicit CellSamples(const SampleSpaceOf<T>& space) : space_(space) {
    for (int axis = 0; axis < 3; ++axis) {
      const float eye = value_of(space.eye[axis]), box = value_of(space.box[axis]);
      eye_cell_[axis] = static_cast<int>(std::floor(std::fmin(std::fmax(eye, -1.0F), box)));
    }
  }

  void begin(const glm::vec<3, T>& d) {
    const T scale = space_.step / sqrt_of(d.x * d.x + d.y * d.y + d.z * d.z);
    T enter = T(0.0F), leave = T(0.0F);
    bool bounded = false, beside = false;
    for (int axis = 0; axis < 3; ++axis) {
      step_[axis] = d[axis] * scale;
      if (value_of(step_[axis]) == 0) {
        const float eye = value_of(space_.eye[axis]);
        beside = beside || !(eye >= 0 && eye < value_of(space_.box[axis]));
        continue;
      }
      const T inverse = T(1.0F) / step_[axis];
      T near = (T(0.0F) - space_.eye[axis]) * inverse;
      T far = (space_.box[axis] - space_.eye[axis]) * inverse;
      if (value_of(step_[axis]) < 0) std::swap(near, far);
      enter = max_of(enter, near);
      leave = bounded ? min_of(leave, far) : far;
      bounded = true;
    }
    using std::ceil;
    using std::floor;
    at_ = ceil(enter);
    last_ = beside ? T(-1.0F) : floor(min_of(leave, space_.far));
  }

  // No sample is left. Also where the direction has no length.
  bool done() const { return !(at_ <= last_); }
  void next() { at_ = at_ + T(1.0F); }
  std::uint64_t left() const {
    return done() ? 0 : static_cast<std::uint64_t>(value_of(last_) - value_of(at_)) + 1;
  }

  // Finds the cell of the sample. False where rounding has put it a hair beside the box.
  bool find_cell(glm::vec<3, Index>& cell) const {
    using std::floor;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const T place = floor(space_.eye[axis] + at_ * step_[axis]);
      inside = inside && T(0.0F) <= place && place < space_.box[axis];
      if (inside) cell[axis] = static_cast<Index>(place);
    }
    return inside;
  }

  // Manhattan distance of a cell from the eye's.
  std::uint32_t cells_from_eye(const glm::ivec3& cell) const {
    return sgs::cells_from_eye(eye_cell_, cell);
  }

 private:
  SampleSpaceOf<T> space_;
  glm::ivec3 eye_cell_{0};  // beyond the box the cell next to it stands for it
  glm::vec<3, T> step_{};
  T at_{}, last_{};  // numbers of samples from the eye
};

// The voxels that the samples of a ray lie in, found from the root of the tree; used as RayPath.
class CellSamplePath {
 public:
  CellSamplePath(const VoxelFrame& frame, const SampleSpace& space)
      : frame_(frame), samples_(space) {}

  void begin(const Ray& ray) {
    samples_.begin(ray.direction);
    before_ = glm::ivec3(-1);
    now_ = Now::kAtSample;
  }

  RayEventOf next() {
    if (now_ == Now::kInNode && found_) {
      if (level_ > 0) return {RayEvent::kLookUp, index_};
      now_ = Now::kDone;
      return {RayEvent::kVoxel, index_, samples_.cells_from_eye(before_)};
    }
    if (now_ != Now::kAtSample) {
      samples_.next();
      now_ = Now::kAtSample;
      if (!samples_.done()) return {RayEvent::kStep};
    }
    if (samples_.done()) return {RayEvent::kEnd};
    glm::ivec3 cell;
    now_ = Now::kDone;
    if (!samples_.find_cell(cell) || cell == before_) return next();
    before_ = cell;
    level_ = frame_.levels;
    return {RayEvent::kLookUp, 0};
  }

  void give(const VoxelNode& node) {
    const unsigned shift = static_cast<unsigned>(2 * --level_);
    const glm::uvec3 at = glm::uvec3(before_) >> shift & 3U;
    const unsigned bit = child_bit(at.x, at.y, at.z);
    found_ = (node.occupied >> bit & 1U) != 0;
    index_ = node.first_child + static_cast<std::uint32_t>(__builtin_popcountll(
                                    node.occupied & ((std::uint64_t{1} << bit) - 1)));
    now_ = Now::kInNode;
  }

 private:
  enum class Now : std::uint8_t { kAtSample, kInNode, kDone };

  VoxelFrame frame_;
  CellSamples<> samples_;
  glm::ivec3 before_{-1};  // cell of the last sample inside the box
  Now now_ = Now::kAtSample;
  int level_ = 0;  // of the block that was looked into last
  std::uint32_t index_ = 0;
  bool found_ = false;
};

}  // namespace sgs

// The Gaussian in a PLY vertex: where its parameters stand, how they are stored in a cloud, and
// what is wrong with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_header.h"

namespace sgs {

// The parameters of one Gaussian in a fixed order of "slots", whatever the order in the file:
// x y z, f_dc_0..2, opacity, scale_0..2, rot_0..3, then f_rest_0.. as in the file, channel-major.
constexpr int kMeanSlot = 0, kDcSlot = 3, kOpacitySlot = 6, kScaleSlot = 7, kRotationSlot = 10,
              kRestSlot = 14, kMaxSlots = 59;

// Name of the property that fills a slot.
std::string slot_name(int slot);

// Mip-Splatting's size of the smoothing filter of a Gaussian, in world units: in no cloud, but in
// the scales and the opacity that it holds.
constexpr int kFilterSlot = kMaxSlots;
constexpr const char* kFilterProperty = "filter_3D";

struct VertexLayout {
  struct Column {
    std::size_t property = 0;        // index among the element's properties
    std::uint32_t offset_bytes = 0;  // in a binary record
    PlyScalar type = PlyScalar::kFloat32;
  };
  std::vector<Column> columns;  // one a slot, then filter_3D where there is one
  bool has_filter = false;
  int sh_degree = 0;  // 0 to 3, from the number of f_rest
  std::uint64_t record_bytes = 0;
};

// Finds the slots among the properties of `vertex`. Throws InputError that names the property when
// one is missing or a list, or when the count of f_rest fits no SH degree; `path` is for the text.
VertexLayout layout_of_vertex(const std::string& path, const PlyElement& vertex);

// Widens the Gaussian by `filter` along each axis and dims it by as much, as Mip-Splatting bakes
// its 3D filter (Yu et al. 2024, get_scaling_with_3D_filter, get_opacity_with_3D_filter):
// s' = sqrt(s^2 + f^2), opacity' = opacity sqrt(prod s^2 / prod s'^2). 0 changes nothing, nor
// does it where a scale is one that store_vertex() faults.
void bake_filter(float filter, float* slots);

// A vertex that cannot be used: the slot with a value that activation makes no number of or that is
// beyond gaussian_cloud.h, or kRotationSlot with the value 0 when the quaternion has length zero.
// An opacity logit may be infinite (opacity 1 or 0), a logarithm of a scale -infinite (flat).
struct VertexFault {
  std::uint64_t vertex = 0;
  int slot = 0;
  float value = 0;
};

// Stores the slots of vertex `index` in `cloud` (already resized) and adds to `faults` when they
// cannot be used. Different vertices may be stored from different threads, each with its own
// `faults`.
void store_vertex(const float* slots, std::uint64_t index, GaussianCloud& cloud,
                  std::vector<VertexFault>& faults);

// Leaves out of `contents` the vertices of `faults` (ascending, each once) and counts them; the
// others keep their order. Throws InputError of the first one where `options` do not say so.
void settle_faults(const std::string& path, const std::vector<VertexFault>& faults,
                   const SceneReadOptions& options, SceneContents& contents);

}  // namespace sgs

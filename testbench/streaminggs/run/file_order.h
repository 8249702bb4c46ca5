// The error of a picture because ties of depth are broken by storage slot. Renderers of the scene's
// file break them by place in the file.
#pragma once

#include <cstdint>
#include <optional>

#include "algorithm/image/image.h"
#include "algorithm/splat/view.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs {

// The reference picture in storage order against the one in the order of the file.
struct FileOrderDifference {
  double psnr_db;  // infinite where they are equal
  double max_abs_error = 0;
  std::uint64_t pixels = 0;  // pixels that differ in any bit of a channel's value
};

// reference: of scene.given(). The other picture is made only of tiles where some tie is broken
// otherwise; elsewhere both are the same by construction. None of a packed scene: its file's order
// is not known.
std::optional<FileOrderDifference> file_order_difference(const PreparedScene& scene,
                                                         const View<float>& view,
                                                         const glm::vec3& background,
                                                         const Image& reference);

}  // namespace sgs

// Time, bytes and energy of a frame of the original rasteriser on a GPU, modelled: each kernel
// takes as long as its instructions or its bytes, whichever is longer; kernels one after the other.
#pragma once

#include <string>
#include <vector>

#include "testbench/gpu/gpu_config.h"
#include "testbench/gpu/raster_work.h"

namespace sgs {

// The parts of a frame for which shares of traffic are published.
enum class GpuPart { kProjection, kSorting, kRendering };

struct GpuStage {
  std::string name;
  GpuPart part;
  double instructions = 0;        // counted in warps
  double scene_bytes = 0;         // parameters of Gaussians
  double intermediate_bytes = 0;  // between kernels, written and read
  double frame_bytes = 0;         // pixels
  double seconds = 0;
  bool bound_by_bytes = false;

  double bytes() const { return scene_bytes + intermediate_bytes + frame_bytes; }
};

struct GpuFrame {
  std::vector<GpuStage> stages;
  double seconds = 0, joules = 0;

  double bytes() const;
  double bytes_of(GpuPart part) const;
  double intermediate_bytes() const;
};

GpuFrame model_gpu(const RasterWork& work, const GpuConfig& config);

}  // namespace sgs

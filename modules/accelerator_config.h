// Everything that can be chosen about the accelerator; the defaults are the paper's (StreamingGS,
// DAC 2025) or, where it leaves a parameter open, stated with a reason in the README.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/second_half.h"
#include "modules/config/config_visitor.h"
#include "modules/dram/dram_config.h"
#include "modules/hfu/codebook_config.h"
#include "modules/hfu/hfu_config.h"
#include "modules/merge/merge_config.h"
#include "modules/rendering/rendering_config.h"
#include "modules/sorting/sorting_config.h"
#include "modules/vsu/vsu_config.h"

namespace sgs {

// Decides what VSU emits and whether a merge stage stands before rendering; nothing else.
enum class Ordering { kExact, kPaper };

struct SramConfig {
  std::uint32_t input_bytes = 16 * 1024;      // first halves, double-buffered
  std::uint32_t codebook_bytes = 250 * 1024;  // idle unless second halves are quantised
  std::uint32_t shared_bytes = 89 * 1024;     // everything between the stages
};

struct MemoryPortConfig {
  std::uint32_t max_transaction_bytes = 256;
  std::uint32_t max_outstanding = 16;  // transactions of one unit
};

struct AcceleratorConfig {
  Ordering ordering = Ordering::kExact;
  double clock_mhz = 1000;
  std::uint32_t group_px = 32;
  double voxel_size = 0;               // paper order: world units; 0: from the scene's extent
  std::uint32_t chunk_gaussians = 16;  // exact order: most Gaussians in a chunk
  SecondHalfEncoding encoding = SecondHalfEncoding::kRaw;
  VqConfig vq;  // how codebooks are made
  FrameFormat framebuffer = FrameFormat::kRgb8;
  bool store_invisible = false;  // also Gaussians that no view can show
  std::uint32_t hfus = 4;
  std::uint32_t sorting_units = 2;
  SramConfig sram;
  VsuConfig vsu;
  HfuConfig hfu;
  CodebookConfig codebook;
  SortingConfig sorting;
  MergeConfig merge;
  RenderingConfig rendering;
  MemoryPortConfig memory_port;
  DramConfig dram;

  // Throws InputError for a combination that cannot be built; the message shows the arithmetic.
  void validate() const;
};

// One use of on-chip memory.
struct SramUse {
  std::string name;
  std::uint64_t bytes;
  std::string arithmetic;  // how the bytes come about
};

struct SramBudget {
  std::vector<SramUse> input, shared;
  static std::uint64_t total(const std::vector<SramUse>& uses);
};
SramBudget sram_budget(const AcceleratorConfig& config);

// Throws InputError when the codebooks of a scene do not fit their buffer; the message shows the
// sum.
void check_codebooks(const AcceleratorConfig& config, const SecondHalfFormat& format);

void visit(ConfigVisitor& v, SramConfig& config);
void visit(ConfigVisitor& v, VsuConfig& config);
void visit(ConfigVisitor& v, HfuConfig& config);
void visit(ConfigVisitor& v, VqConfig& config);
void visit(ConfigVisitor& v, CodebookConfig& config);
void visit(ConfigVisitor& v, SortingConfig& config);
void visit(ConfigVisitor& v, MergeConfig& config);
void visit(ConfigVisitor& v, RenderingConfig& config);
void visit(ConfigVisitor& v, MemoryPortConfig& config);
void visit(ConfigVisitor& v, AcceleratorConfig& config);

}  // namespace sgs

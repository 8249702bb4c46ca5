// Design of paper order: requirements on the scene, golden frame, and the machine that is built.
#include "modules/streaminggs/paper_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/memory/splat_record.h"
#include "algorithm/render/paper_losses.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/paper_machine.h"
#include "modules/streaminggs/pipeline_depths.h"
#include "modules/streaminggs/streaming_design.h"
#include "modules/streaminggs/streaming_sram.h"
#include "modules/streaminggs/vsu/sampled_rays.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

// Bytes for two copies of the longest list, for each list being sorted; none where every list fits.
std::uint64_t spill_bytes(const PaperConfig& config, const VoxelGrid& grid) {
  const std::uint32_t most = config.vsu.visit_gaussians;
  if (most > 0 && std::max(most, kLeastCut) <= config.sorting.buffer_entries) return 0;
  std::uint64_t longest = 0;
  for (const VoxelRecord& voxel : grid.voxels) {
    longest = std::max<std::uint64_t>(longest, voxel.count);
  }
  return config.lists() * 2 * longest * splat_entry_bytes(config.splats);
}

}  // namespace

void PaperDesign::resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) {
  storage_ = storage;
  check(config_);
  const OperationLatencies latencies = config_.single_latencies();
  if (config_.vsu.samples()) {
    resolve_sampling_depths(latencies, chosen);
  } else {
    resolve_step_depths(latencies, chosen);
  }
  resolve_rendering_depths(config_, chosen);
  resolve_sram(
      config_, storage_, sram_, [&] { return sram_uses(config_, storage_); }, chosen);
  check_rays(config_);
}

void PaperDesign::resolve_step_depths(const OperationLatencies& latencies,
                                      std::vector<AutoChoice>& chosen) {
  // A step reads the ray's context and writes it.
  constexpr std::uint32_t kContext = kReadCycles + kWriteCycles;
  resolve_depth("vsu.step_depth_cycles", config_.vsu.step_depth_cycles,
                ray_step_pipeline(config_.vsu, latencies),
                ray_step_flow(longest_step_case()).longest_path(latencies), latencies, kContext,
                chosen);
  resolve_depth("vsu.cell_step_depth_cycles", config_.vsu.cell_step_depth_cycles,
                cell_step_pipeline(config_.vsu, latencies),
                ray_step_flow(cell_step_case()).longest_path(latencies), latencies, kContext,
                chosen);
  resolve_depth("vsu.ray_depth_cycles", config_.vsu.ray_depth_cycles,
                pixel_ray_pipeline(config_.vsu, latencies),
                pixel_ray_flow().longest_path(latencies), latencies, kWriteCycles, chosen);
}

// A ray that has begun is written, and read when it is sampled.
void PaperDesign::resolve_sampling_depths(const OperationLatencies& latencies,
                                          std::vector<AutoChoice>& chosen) {
  resolve_depth("vsu.step_depth_cycles", config_.vsu.step_depth_cycles,
                ray_sample_pipeline(config_.vsu, latencies),
                ray_sample_flow().longest_path(latencies), latencies, kReadCycles, chosen);
  resolve_depth("vsu.ray_depth_cycles", config_.vsu.ray_depth_cycles,
                sampled_ray_pipeline(config_.vsu, latencies),
                sampled_ray_flow().longest_path(latencies), latencies, kWriteCycles, chosen);
}

void PaperDesign::adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) {
  sgs::adapt(config_, storage_order(), format, chosen);
}

FrameJob PaperDesign::job(const StoredScene& scene, const Camera& camera) const {
  FrameJob job = scene_job(config_, scene, camera);
  add_frame_buffers(job);
  add_spill(job, spill_bytes(config_, scene.grid()));  // by the buffers
  if (config_.vsu.samples()) SampledRays::place_tables(config_.vsu, scene.grid(), job);
  return job;
}

std::optional<PaperOrderConfig> PaperDesign::paper_order() const {
  PaperOrderConfig order;
  order.group = config_.group();
  order.coarse_filter = config_.hfu.coarse_filter;
  order.rays = config_.vsu.rays();
  order.table_bytes = config_.vsu.table_bytes;
  order.line_destinations = config_.vsu.line_destinations();
  order.visit_gaussians = config_.vsu.visit_gaussians;
  order.parts = config_.parts();
  order.splats = config_.splats;
  order.precision = config_.rendering.precision;
  order.subtile_test = config_.rendering.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox;
  return order;
}

std::string PaperDesign::golden_key() const {
  const PaperOrderConfig of = *paper_order();
  return fmt::format("{}x{} {} {}/{}/{}/{}/{} {}/{} {} {} {} {}", of.group.width, of.group.height,
                     of.coarse_filter, of.rays.step_px, of.rays.sample_step_voxels,
                     of.rays.sample_far_voxels, of.rays.side_by_side, of.rays.by_coordinates,
                     of.table_bytes, of.line_destinations, of.visit_gaussians, of.parts,
                     static_cast<int>(of.splats), static_cast<int>(of.precision));
}

GoldenFrame PaperDesign::golden(const StoredScene& scene, const FrameJob& job,
                                DataSheet& sheet) const {
  PaperOrderConfig order = *paper_order();
  order.background = job.background;
  StreamingResult result = render_paper_order(job.view, scene.decoded, scene.grid(), order);
  publish_left_out(scene, result.stats.blocks_reached, sheet);
  std::vector<std::vector<std::uint32_t>> visited = std::move(result.group_voxels);
  GoldenFrame golden = golden_frame(std::move(result), streaming_job(config_, job).groups);
  golden.in_order = [&scene, view = job.view, background = job.background, group = order.group,
                     voxels = std::move(visited)] {
    return render_visited_in_order(view, scene.decoded, scene.grid(), group, voxels, background);
  };
  if (config_.rendering.precision != BlendPrecision::kSingle ||
      config_.splats != NumberFormat::kSingle) {
    order.precision = BlendPrecision::kSingle;
    order.splats = NumberFormat::kSingle;
    golden.computed_exactly = [&scene, view = job.view, exactly = order] {
      return render_paper_order(view, scene.decoded, scene.grid(), exactly).frame.image;
    };
  }
  return golden;
}

void PaperDesign::publish_left_out(const StoredScene& scene, std::uint64_t voxels_met,
                                   DataSheet& sheet) const {
  sgs::publish_left_out(config_, scene, sheet);
  const VoxelTableLayout& table = scene.image.layout.voxel_table();
  sheet.left_out("voxels_not_needed", "no ray of any group crosses them",
                 table.voxels.count - voxels_met, "their Gaussians are never fetched");
  const double side = table.frame.side_cells();
  const double cells = side * side * side;
  sheet.left_out("empty_cells", "only occupied cells exist in the voxel tree",
                 static_cast<std::uint64_t>(cells - static_cast<double>(table.voxels.count)),
                 fmt::format("a dense table would take {:.3g} B", cells * sizeof(VoxelRecord)));
}

std::unique_ptr<Machine> PaperDesign::build(const sc_core::sc_module_name& name,
                                            const FrameJob& job,
                                            const BuildOptions& options) const {
  return std::make_unique<PaperMachine>(name, config_, streaming_job(config_, job),
                                        built_for(config_, storage_), options);
}

}  // namespace sgs

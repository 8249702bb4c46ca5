// Design of exact order: requirements on the scene, golden frame, and the machine that is built.
#include "modules/streaminggs/exact_design.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/streaminggs/exact_machine.h"
#include "modules/streaminggs/pipeline_depths.h"
#include "modules/streaminggs/streaming_design.h"
#include "modules/streaminggs/streaming_sram.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {

void ExactDesign::resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) {
  storage_ = storage;
  if (config_.hfu.eyes > 1 && config_.merge.on_overflow == OnOverflow::kBlendEarly) {
    throw InputError(
        "merge.on_overflow: got blend_early with eyes 2, expected spill: what waits for one eye "
        "would decide the picture of the other");
  }
  resolve_rendering_depths(config_, chosen);
  resolve_sram(
      config_, storage_, sram_, [&] { return sram_uses(config_, storage_); }, chosen);
}

void ExactDesign::adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) {
  sgs::adapt(config_, storage_order(), format, chosen);
  const OperationLatencies latencies = config_.single_latencies();
  resolve_depth("vsu.test_depth_cycles", config_.vsu.test_depth_cycles,
                chunk_test_pipeline(config_.vsu, config_.hfu.eyes, latencies),
                chunk_flow(longest_chunk_case(config_.hfu.eyes)).longest_path(latencies), latencies,
                0, chosen);
}

FrameJob ExactDesign::job(const StoredScene& scene, const Camera& camera) const {
  check_eyes(config_.hfu.eyes, camera);
  constexpr std::uint64_t kMostSlots = std::uint64_t{1} << MergeUnit::kSlotBits;
  if (scene.image.layout.gaussian_count() > kMostSlots) {
    throw InputError(fmt::format(
        "scene: got {} Gaussians, expected at most {}: machine exact tells the eyes of a key in "
        "the word of its slot",
        scene.image.layout.gaussian_count(), kMostSlots));
  }
  FrameJob job = scene_job(config_, scene, camera);
  add_spill(job, exact_spill_bytes(scene.image.layout));  // by the scene alone
  add_frame_buffers(job);
  return job;
}

bool ExactDesign::draws_reference() const {
  return config_.rendering.precision == BlendPrecision::kSingle &&
         config_.merge.on_overflow == OnOverflow::kSpill;
}

ExactOrderConfig ExactDesign::order() const {
  ExactOrderConfig order;
  order.group = config_.group();
  order.coarse_filter = config_.hfu.coarse_filter;
  order.merge_entries = config_.merge.entries;
  order.on_overflow = config_.merge.on_overflow;
  order.walk_room = config_.vsu.walk_room();
  order.precision = config_.rendering.precision;
  order.subtile_test = config_.rendering.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox;
  return order;
}

// The reference picture blends what it blends however it is streamed.
std::string ExactDesign::golden_key() const {
  if (draws_reference()) return "reference";
  const ExactOrderConfig of = order();
  return fmt::format("{}x{} {} {} {} {}/{} {}", of.group.width, of.group.height, of.coarse_filter,
                     of.merge_entries, static_cast<int>(of.on_overflow), of.walk_room.nodes,
                     of.walk_room.chunks, static_cast<int>(of.precision));
}

GoldenFrame ExactDesign::golden(const StoredScene& scene, const FrameJob& job,
                                DataSheet& sheet) const {
  ExactOrderConfig order = this->order();
  order.background = job.background;
  StreamingResult result = render_exact_order(job.view, scene.decoded, scene.tree(), order);
  publish_left_out(scene, result.stats, sheet);
  const std::vector<PixelRect> groups = streaming_job(config_, job).groups;
  GoldenFrame golden = golden_frame(std::move(result), groups);
  if (job.eyes > 1) {
    const View<float>& right = job.picture(0, 1).view;
    golden.add_right_eye(
        golden_frame(render_exact_order(right, scene.decoded, scene.tree(), order), groups));
  }
  if (config_.rendering.precision == BlendPrecision::kSingle) return golden;
  order.precision = BlendPrecision::kSingle;
  golden.computed_exactly = [&scene, view = job.view, exactly = order] {
    return render_exact_order(view, scene.decoded, scene.tree(), exactly).frame.image;
  };
  return golden;
}

void ExactDesign::publish_left_out(const StoredScene& scene, const StreamingStats& stats,
                                   DataSheet& sheet) const {
  sgs::publish_left_out(config_, scene, sheet);
  sheet.left_out("chunks_not_needed", "they cannot touch any group",
                 scene.image.layout.chunk_table().chunk_count - stats.blocks_reached,
                 "their Gaussians are never fetched");
}

std::unique_ptr<Machine> ExactDesign::build(const sc_core::sc_module_name& name,
                                            const FrameJob& job,
                                            const BuildOptions& options) const {
  return std::make_unique<ExactMachine>(name, config_, streaming_job(config_, job),
                                        built_for(config_, storage_), options);
}

}  // namespace sgs

// Design of the tile-centric machine: requirements on the scene, golden frame, and the machine that
// is built.
#include "modules/gscore/gscore_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "algorithm/render/tile_renderer.h"
#include "modules/gscore/gscore_machine.h"
#include "modules/gscore/list_memory.h"
#include "modules/memory_too_small.h"

namespace sgs::gscore {

void GscoreDesign::fit_frames(const std::function<std::vector<PixelSize>()>& frames) {
  for (const PixelSize& frame : frames()) {
    const auto tiles = [](int px) { return (px + kTilePx - 1) / kTilePx; };
    tiles_ = std::max(tiles_, config_.eyes * static_cast<std::uint32_t>(tiles(frame.width) *
                                                                        tiles(frame.height)));
  }
}

void GscoreDesign::resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) {
  constexpr std::uint32_t kTilesOfAnyFrame = 4096;  // where none is going to be drawn
  check(config_);
  const bool decides = lists_open(config_);  // by the memory's size
  choose_list_memory(config_, tiles_ > 0 ? tiles_ : kTilesOfAnyFrame, chosen);
  if (storage.encoding != SecondHalfEncoding::kRaw &&
      storage.encoding != SecondHalfEncoding::kHalf) {
    throw InputError(fmt::format(
        "storage.encoding: got {}, expected raw or half: machine gscore has no codebooks",
        kEncodingNames[static_cast<std::size_t>(storage.encoding)]));
  }
  const SramUses uses = sram_uses(config_);
  const std::uint64_t needed = sram_bytes(uses, kBuffer);
  std::uint32_t& bytes = config_.sram.buffer_bytes;
  if (bytes != 0 && needed > bytes && (decides || !memory_fitted_)) {
    const std::string refusal = fmt::format(
        "sram.buffer_bytes: {} bytes are there{}, expected at least {}, or 0 for as many as that: "
        "{}",
        bytes, decides ? " to decide the lists by" : "", needed, largest_uses(uses, kBuffer));
    if (decides) throw InputError(refusal);
    throw MemoryTooSmall(refusal);
  }
  if (bytes == 0 || memory_fitted_) {
    bytes = static_cast<std::uint32_t>(needed);
    chosen.push_back({ChoiceKind::kDerived, "sram.buffer_bytes", static_cast<double>(needed),
                      sram_sum(uses, kBuffer)});
  }
}

void GscoreDesign::adapt(const SecondHalfFormat&, std::vector<AutoChoice>&) {}

FrameJob GscoreDesign::job(const StoredScene& scene, const Camera& camera) const {
  if (config_.culls_chunks() && scene.tree().depth > config_.culling.tree_levels) {
    throw InputError(fmt::format(
        "culling.tree_levels: got {}, expected {} or more: the levels of the scene's chunk tree",
        config_.culling.tree_levels, scene.tree().depth));
  }
  check_eyes(config_.eyes, camera);
  FrameJob job;
  job.view = make_view<float>(camera);
  job.layout = scene.image.layout;
  job.frame_format = config_.framebuffer;
  add_regions(config_, job);
  return job;
}

GoldenFrame GscoreDesign::golden(const StoredScene& scene, const FrameJob& job,
                                 DataSheet& sheet) const {
  TileOrderConfig order = config_.order();
  order.background = job.background;
  const ChunkTree* boxes = config_.culls_chunks() ? &scene.tree() : nullptr;
  const auto of_eye = [&](std::uint32_t eye) {
    TileResult result = render_tiles(job.picture(0, eye).view, scene.decoded, order, boxes);
    const TileStats& stats = result.stats;
    sheet.left_out("tiles_not_touched", "boxes along the ellipses", stats.tile_tests - stats.pairs,
                   "entries of lists");
    GoldenFrame golden;
    golden.image = std::move(result.frame.image);
    golden.blends = stats.contributors;
    golden.contributing = stats.contributing;
    golden.misordered = stats.misordered;
    return golden;
  };
  GoldenFrame golden = of_eye(0);
  if (job.eyes > 1) golden.add_right_eye(of_eye(1));
  TileOrderConfig exactly = TileOrderConfig::lossless();
  exactly.rules.test = order.rules.test;
  exactly.rules.subtiles_across = order.rules.subtiles_across;
  exactly.keys = order.keys;
  exactly.chunk_entries = order.chunk_entries;
  exactly.background = order.background;
  if (order.rules.reach != exactly.rules.reach || order.features != exactly.features ||
      order.precision != exactly.precision) {
    golden.computed_exactly = [&scene, view = job.view, exactly] {
      return render_tiles(view, scene.decoded, exactly).frame.image;
    };
  }
  return golden;
}

std::string GscoreDesign::golden_key() const {
  const TileOrderConfig of = config_.order();
  return fmt::format("{} {} {} {} {} {} {} {}", static_cast<int>(config_.culling.by),
                     static_cast<int>(of.rules.reach), static_cast<int>(of.rules.test),
                     of.rules.subtiles_across, static_cast<int>(of.features),
                     static_cast<int>(of.keys), static_cast<int>(of.precision), of.chunk_entries);
}

std::unique_ptr<Machine> GscoreDesign::build(const sc_core::sc_module_name& name,
                                             const FrameJob& job,
                                             const BuildOptions& options) const {
  return std::make_unique<GscoreMachine>(name, config_, gscore_job(config_, job), options);
}

}  // namespace sgs::gscore

// Costs, regions and savings that do not depend on the order.
#include "modules/streaminggs/streaming_design.h"

#include <fmt/format.h>

#include "algorithm/render/group_parts.h"
#include "algorithm/render/group_state.h"
#include "modules/streaminggs/filter_cost.h"
#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "modules/streaminggs/pipeline_depths.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {
namespace {

constexpr int kMaxDegree = 3;

}  // namespace

void adapt(StreamingConfig& config, StorageOrder order, const SecondHalfFormat& format,
           std::vector<AutoChoice>& chosen) {
  const RecordSplit split = split_of(order, format);
  for (AutoChoice& cost : resolve_filter_cost(config.hfu, split, format.sh_degree)) {
    chosen.push_back(std::move(cost));
  }
  resolve_filter_depths(config, split, format.sh_degree, chosen);
  check_sram("sram.codebook_bytes", config.sram.codebook_bytes,
             CodebookBuffer::sram_uses(config.codebook, format), kCodebookSram, "");
}

StreamingJob streaming_job(const StreamingConfig& config, const FrameJob& job) {
  StreamingJob out;
  static_cast<FrameJob&>(out) = job;
  out.groups = pixel_groups(job.view.width, job.view.height, config.group());
  out.parts = group_parts(out.groups, config.group(), config.parts());
  return out;
}

StreamingJob streaming_job(const StreamingConfig& config, const StoredScene& scene,
                           const Camera& camera, std::uint64_t spill_bytes) {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.frame_format = config.framebuffer;
  job.layout = scene.image.layout;
  job.spill = job.layout.regions.add("spill", spill_bytes);
  job.frame_buffer =
      job.layout.regions.add("frame_buffer", std::uint64_t{pixel_bytes(config.framebuffer)} *
                                                 camera.width * camera.height);
  return streaming_job(config, job);
}

GoldenFrame golden_frame(StreamingResult&& result, const std::vector<PixelRect>& groups) {
  const StreamingStats& stats = result.stats;
  GoldenFrame golden;
  golden.image = std::move(result.frame.image);
  golden.blends = stats.contributors;
  golden.contributing = stats.contributing;
  golden.misordered = stats.misordered;
  golden.missed = stats.missed;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const StreamingStats& of_group = result.of_groups[g];
    golden.groups.push_back(
        {groups[g], of_group.contributors, of_group.misordered, of_group.missed});
  }
  return golden;
}

void publish_left_out(const StreamingConfig& config, const StoredScene& scene, DataSheet& sheet) {
  const SecondHalfFormat& format = scene.image.layout.second_half;
  SecondHalfFormat full{format.encoding, kMaxDegree, {}};
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    full.entries[id] = format.quantised() ? scene.storage.vq.entries(static_cast<Codebook>(id)) : 0;
  }
  SecondHalfFormat of_degree = full;
  of_degree.sh_degree = format.sh_degree;
  if (format.sh_degree == 0) of_degree.entries[static_cast<std::size_t>(Codebook::kSh)] = 0;
  const auto bytes = [&](const SecondHalfFormat& of) {
    const RecordSplit split = split_of(scene.image.layout.order(), of);
    return split.first_bytes() + split.second_bytes;
  };
  const std::string degree = fmt::format("the scene has SH degree {}", format.sh_degree);
  if (format.sh_degree < kMaxDegree) {
    sheet.left_out("sh_bands", degree.c_str(), scene.image.layout.gaussian_count(),
                   fmt::format("{} B a Gaussian", bytes(full) - bytes(of_degree)));
  }
  if (!format.quantised()) {
    sheet.left_out("codebooks", "second halves are not quantised",
                   config.sram.codebook_bytes > 0 ? 1 : 0,
                   fmt::format("{} B of SRAM stay empty", config.sram.codebook_bytes));
    return;
  }
  if (format.sh_degree < kMaxDegree) {
    sheet.left_out("codebook_words", degree.c_str(), 1,
                   fmt::format("{} B of DRAM, of the load and of SRAM",
                               full.codebook_bytes() - of_degree.codebook_bytes()));
  }
  std::uint32_t fewer = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    fewer += of_degree.entries[id] - format.entries[id];
  }
  sheet.left_out("codebook_entries", "the scene has no more distinct values", fewer,
                 fmt::format("{} B of DRAM, of the load and of SRAM, {} B a Gaussian",
                             of_degree.codebook_bytes() - format.codebook_bytes(),
                             bytes(of_degree) - bytes(format)));
  sheet.left_out("codebook_load", "an earlier frame left them in the buffer",
                 config.codebook.preloaded ? 1 : 0,
                 fmt::format("{} B of traffic", format.codebook_bytes()));
}

}  // namespace sgs

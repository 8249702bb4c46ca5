// Costs, regions and savings that do not depend on the order.
#include "modules/streaminggs/streaming_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "algorithm/render/group_shape.h"
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
  check_sram<InputError>("sram.codebook_bytes", config.sram.codebook_bytes,
                         CodebookBuffer::sram_uses(config.codebook, format), kCodebookSram, "");
}

StreamingJob streaming_job(const StreamingConfig& config, const FrameJob& job) {
  StreamingJob out;
  static_cast<FrameJob&>(out) = job;
  const std::vector<PixelRect> of_frame =
      pixel_groups(job.view.width, job.view.height, config.group());
  for (std::uint32_t frame = 0; frame < job.frames(); ++frame) {
    out.groups.insert(out.groups.end(), of_frame.begin(), of_frame.end());
  }
  const auto parts = group_parts(out.groups, config.group(), config.parts_of_group());
  for (std::uint32_t eye = 0; eye < job.eyes; ++eye) {
    out.parts.insert(out.parts.end(), parts.begin(), parts.end());
  }
  return out;
}

FrameJob scene_job(const StreamingConfig& config, const StoredScene& scene, const Camera& camera) {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.frame_format = config.framebuffer;
  job.layout = scene.image.layout;
  return job;
}

void add_spill(FrameJob& job, std::uint64_t bytes) {
  job.spill = job.layout.regions.add("spill", bytes);
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
  constexpr auto kSh = static_cast<std::size_t>(Codebook::kSh);
  if (!format.quantised()) {
    const std::uint64_t fewer = kCodebookCount - (format.sh_degree == 0 ? 1 : 0);
    sheet.left_out("codebooks", "second halves are not quantised",
                   config.sram.codebook_bytes > 0 ? fewer : 0,
                   fmt::format("{} B of SRAM stay empty", config.sram.codebook_bytes));
    return;
  }
  if (format.sh_degree < kMaxDegree) {
    SecondHalfFormat whole = format;
    whole.sh_degree = kMaxDegree;
    whole.entries[kSh] = std::max(1U, format.entries[kSh]);
    const std::uint32_t fewer = whole.codebook_bytes() - format.codebook_bytes();
    const std::string degree =
        fmt::format("the scene is stored with SH degree {}", format.sh_degree);
    sheet.left_out("codebook_words", degree.c_str(), fewer / sizeof(float),
                   fmt::format("{} B of DRAM, of the load and of SRAM", fewer));
  }
  // With codebooks as large as they may become.
  const SecondHalfFormat full = scene.storage.widest_format(format.sh_degree);
  std::uint32_t fewer = 0, fewer_bits = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    fewer += full.entries[id] - format.entries[id];
    fewer_bits += full.index_bits(codebook) - format.index_bits(codebook);
  }
  const auto bytes = [&](const SecondHalfFormat& of) {
    const RecordSplit split = split_of(scene.image.layout.order(), of);
    return split.first_bytes() + split.second_bytes;
  };
  const std::string of_record = fmt::format("{} B a Gaussian", bytes(full) - bytes(format));
  sheet.left_out("codebook_entries", "the scene has no more distinct values", fewer,
                 fmt::format("{} B of DRAM, of the load and of SRAM, {}",
                             full.codebook_bytes() - format.codebook_bytes(), of_record));
  if (format.encoding == SecondHalfEncoding::kVqPacked) {
    sheet.left_out("index_bits", "no more are needed to tell the entries apart", fewer_bits,
                   of_record);
  }
  sheet.left_out("codebook_load", "an earlier frame left them in the buffer",
                 config.codebook.preloaded ? 1 : 0,
                 fmt::format("{} B of traffic", format.codebook_bytes()));
}

}  // namespace sgs

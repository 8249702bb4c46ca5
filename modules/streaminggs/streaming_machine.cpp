// Shared units of the two tops.
#include "modules/streaminggs/streaming_machine.h"

#include <algorithm>

#include "algorithm/render/group_state.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/filter_cost.h"
#include "modules/streaminggs/spare_parts.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {
namespace {

// The job of what renders one part of the groups: its pixels in place of theirs, of its eye.
StreamingJob job_of_part(const StreamingJob& job, std::uint32_t part) {
  StreamingJob out = job;
  static_cast<FrameJob&>(out) = job.of_eye(job.eye_of(part));
  out.groups = job.parts[part];
  out.parts = {out.groups};
  return out;
}

}  // namespace

StreamingMachine::StreamingMachine(const sc_core::sc_module_name& name,
                                   const StreamingConfig& config, const StreamingJob& job,
                                   const BuiltFor& built_for, const BuildOptions& options,
                                   const Tokens& tokens)
    : Machine(name),
      config_(config),
      job_(job),
      built_for_(built_for),
      stalls_(options.stalls),
      clock_(config.clock_mhz, options.jitter_seed),
      parts_drawn_(job.frames()) {
  for (std::uint32_t p = 0; p < config.parts(); ++p) part_jobs_.push_back(job_of_part(job_, p));
  make_finished_groups();
  for (std::uint32_t h = 0; h < config.fetches(); ++h) {
    add_fifo(visits_, fmt::format("visits_to_hfu{}", h), visit_fifos(config));
  }
  make_units(tokens);
  bind();
}

std::string StreamingMachine::name_of_part(const char* what, std::uint32_t part) const {
  return config_.parts() > 1 ? fmt::format("{}{}", what, part) : what;
}

// A part of a group that has no pixels is finished from the start.
void StreamingMachine::make_finished_groups() {
  for (std::uint32_t p = 0; p < config_.parts(); ++p) {
    const std::vector<PixelRect>& groups = part_jobs_[p].groups;
    finished_groups_.push_back(
        std::make_unique<FinishedGroups>(name_of_part("finished_groups", p).c_str(), clock_,
                                         groups.size(), config_.rendering.feedback_latency_cycles));
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      if (groups[g].empty()) finished_groups_[p]->finish(g, 0);
    }
  }
}

void StreamingMachine::make_units(const Tokens& tokens) {
  for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
    hfus_.push_back(
        std::make_unique<Hfu>(fmt::format("hfu{}", h).c_str(), config_.hfu, config_.codebook,
                              FineFilterPlace{h * config_.parts(), tokens.rejects}, context()));
  }
  const auto part_drawn = [this](std::uint32_t frame) {
    if (++parts_drawn_[frame] == config_.parts()) finish_frame(frame, frame + 1 == job_.frames());
  };
  for (std::uint32_t p = 0; p < config_.parts(); ++p) {
    rendering_.push_back(std::make_unique<RenderingUnit>(name_of_part("rendering", p).c_str(),
                                                         rendering_of_part(config_), tokens.arrival,
                                                         part_context(p), part_drawn));
  }
  if (job_.layout.second_half.quantised()) {
    codebooks_ =
        std::make_unique<CodebookBuffer>("codebooks", config_.codebook, context(), instant_end(),
                                         config_.fetches() * config_.parts());
  }
}

void StreamingMachine::bind() {
  for (std::uint32_t p = 0; p < config_.parts(); ++p) {
    rendering_[p]->finish(*finished_groups_[p]);
    rendering_[p]->host(host);
  }
  for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
    hfus_[h]->coarse.shares(*visits_[h]);
    if (codebooks_) hfus_[h]->fine.codebooks(*codebooks_);
    for (const auto& finished : finished_groups_) {
      hfus_[h]->coarse.finished(*finished);
      hfus_[h]->fine.finished(*finished);
    }
  }
}

void StreamingMachine::publish(DataSheet& sheet) {
  publish_units(sheet);
  sheet.unit(*this);
  publish_poses(sheet, job_);
  publish_spare_units(sheet);
  for (const Queue& queue : queues_) {
    sheet.sram(queue.use);
    sheet.queue(*queue.fifo, queue.use.name.c_str());
    if (queue.key != nullptr) sheet.remedy(*queue.fifo, WaitFor::kRoom, queue.key);
  }
  sheet.sram_available(kInputSram, config_.sram.input_bytes);
  sheet.sram_available(kCodebookSram, config_.sram.codebook_bytes);
  sheet.sram_available(kSharedSram, config_.sram.shared_bytes);
}

// Parts of a group that share a fetch have their units for themselves, fed or not.
void StreamingMachine::publish_spare_units(DataSheet& sheet) {
  if (config_.parts_of_group() > 1) return;
  publish_spare(sheet, "spare_hfus", "hfus", config_.hfus,
                units_fed(hfus_,
                          [](const Hfu& hfu) {
                            return hfu.coarse.counters().first_halves +
                                       hfu.fine.counters().second_halves_taken >
                                   0;
                          }),
                1);
  // Clusters that the sub-tiles of any group can use: (x + 2 y) modulo clusters.
  std::uint64_t most = 1;
  for (const PixelRect& px : job_.groups) {
    const std::uint64_t columns = cycles_for(static_cast<std::uint64_t>(px.width()), kSubtilePx);
    const std::uint64_t rows = cycles_for(static_cast<std::uint64_t>(px.height()), kSubtilePx);
    most = std::max(most, columns + 2 * rows - 2);
  }
  publish_spare(sheet, "spare_clusters", "rendering.clusters", config_.rendering.clusters, most, 1);
}

}  // namespace sgs

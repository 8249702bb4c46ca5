// Wiring of the tile-centric machine.
#include "modules/gscore/gscore_machine.h"

#include <algorithm>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"

namespace sgs::gscore {
namespace {

constexpr const char *kPasses = "passes", *kVisible = "visible slices",
                     *kConverted = "converted Gaussians", *kRequests = "tile requests",
                     *kJobs = "tile jobs", *kSorted = "sorted entries", *kDone = "passes done";

// Entries of the FIFO of converted Gaussians, with room for the items in the pipeline.
std::uint32_t converted_entries(const GscoreConfig& c, const Datapath& conversion) {
  return static_cast<std::uint32_t>(
      c.ccu.output_entries + cycles_for(conversion.depth_cycles, conversion.interval_cycles()));
}
// The most such entries, over all SH degrees.
std::uint32_t most_converted_entries(const GscoreConfig& c) {
  std::uint32_t most = 0;
  for (int degree = 0; degree <= kMostDegree; ++degree) {
    most = std::max(most, converted_entries(c, convert_pipeline(c, degree)));
  }
  return most;
}

// Slices that wait ahead of a CCU: a cycle there, a cycle back.
constexpr std::uint32_t kVisibleEntries = 2;

std::uint32_t pass_fifos(const GscoreConfig& c) { return c.culls_chunks() ? 1 : c.ccus; }

SramUse times(SramUse use, std::uint32_t count) {
  use.count = count;
  return use;
}

}  // namespace

SramUses queue_uses(const GscoreConfig& c) {
  SramUses uses = {times(fifo_use<Pass>(kPasses, kBuffer, 1, "passes"), pass_fifos(c)),
                   times(fifo_use<Converted>(kConverted, kBuffer,
                                             c.eyes * most_converted_entries(c), "Gaussians"),
                         c.ccus),
                   times(fifo_use<TileRequest>(kRequests, kBuffer, 1, "requests"), c.cores),
                   times(fifo_use<TileJob>(kJobs, kBuffer, 1, "jobs"), c.cores),
                   times(fifo_use<SortedEntry>(kSorted, kBuffer, c.rendering.sorted_entries,
                                               "entries", SortedEntry::sram_bytes(c.entries())),
                         c.cores),
                   times(fifo_use<PassDone>(kDone, kBuffer, 1, "passes"), c.cores)};
  if (c.culls_chunks()) {
    uses.push_back(
        times(fifo_use<VisibleSlice>(kVisible, kBuffer, kVisibleEntries, "slices"), c.ccus));
  }
  return uses;
}

GscoreMachine::GscoreMachine(const sc_core::sc_module_name& name, const GscoreConfig& config,
                             const GscoreJob& job, const BuildOptions& options)
    : Machine(name),
      config_(config),
      job_(job),
      clock_(config.clock_mhz, options.jitter_seed),
      lister_("lister", context(),
              [this](std::uint32_t frame) { finish_frame(frame, frame + 1 == job_.frames()); }) {
  lister_.host(host);
  add_all_fifos(options);
  make_units();
  bind();
  connect_memory(job_.frames());
}

void GscoreMachine::add_all_fifos(const BuildOptions& options) {
  const Datapath conversion = convert_pipeline(config_, job_.layout.sh_degree());
  if (config_.culls_chunks()) {
    add_fifos(passes_, "passes_to_culler", 1, 1, 1, options);
    add_fifos(visible_, "visible_to_ccu", config_.ccus, kVisibleEntries, 1, options);
  } else {
    add_fifos(passes_, "passes_to_ccu", config_.ccus, 1, 1, options);
  }
  add_fifos(converted_, "converted_by_ccu", config_.ccus, converted_entries(config_, conversion),
            conversion.depth_cycles, options);
  add_fifos(requests_, "requests_of_core", config_.cores, 1, 1, options);
  add_fifos(jobs_, "jobs_of_core", config_.cores, 1, 1, options);
  add_fifos(sorted_, "sorted_of_core", config_.cores, config_.rendering.sorted_entries, 1, options);
  add_fifos(done_, "done_by_core", config_.cores, 1, 1, options);
}

void GscoreMachine::make_units() {
  if (config_.culls_chunks()) culler_ = std::make_unique<ChunkCuller>("culler", context());
  for (std::uint32_t c = 0; c < config_.ccus; ++c) {
    ccus_.push_back(std::make_unique<Ccu>(fmt::format("ccu{}", c).c_str(), c, context()));
  }
  for (std::uint32_t c = 0; c < config_.cores; ++c) {
    finished_.push_back(std::make_unique<FinishedTiles>(fmt::format("finished_tiles{}", c).c_str(),
                                                        clock_, job_.tile_count,
                                                        config_.rendering.feedback_latency_cycles));
    sorters_.push_back(std::make_unique<TileSorter>(fmt::format("sorter{}", c).c_str(), c,
                                                    context(), *finished_[c]));
    renderers_.push_back(std::make_unique<RenderCore>(fmt::format("rendering{}", c).c_str(),
                                                      context(), *finished_[c]));
  }
}

void GscoreMachine::bind() {
  for (const auto& fifo : passes_) lister_.passes(*fifo);
  if (culler_) culler_->passes(*passes_[0]);
  for (std::uint32_t c = 0; c < config_.ccus; ++c) {
    if (culler_) {
      culler_->slices(*visible_[c]);
      ccus_[c]->visible(*visible_[c]);
    } else {
      ccus_[c]->passes(*passes_[c]);
    }
    ccus_[c]->converted(*converted_[c]);
    lister_.converted(*converted_[c]);
  }
  for (std::uint32_t c = 0; c < config_.cores; ++c) {
    sorters_[c]->requests(*requests_[c]);
    lister_.requests(*requests_[c]);
    lister_.jobs(*jobs_[c]);
    sorters_[c]->jobs(*jobs_[c]);
    sorters_[c]->sorted(*sorted_[c]);
    renderers_[c]->sorted(*sorted_[c]);
    renderers_[c]->done(*done_[c]);
    renderers_[c]->host(host);
    lister_.done(*done_[c]);
  }
}

template <class T>
void GscoreMachine::publish_queues(DataSheet& sheet, const Fifos<T>& fifos, const char* use,
                                   const char* key) {
  for (const auto& fifo : fifos) {
    sheet.queue(*fifo, use);
    sheet.remedy(*fifo, WaitFor::kRoom, key);
  }
}

void GscoreMachine::publish(DataSheet& sheet) {
  if (culler_) culler_->publish(sheet);
  for (const auto& ccu : ccus_) ccu->publish(sheet);
  lister_.publish(sheet);
  for (std::uint32_t c = 0; c < config_.cores; ++c) {
    sorters_[c]->publish(sheet);
    renderers_[c]->publish(sheet);
  }
  sheet.unit(*this);
  publish_poses(sheet, job_);
  sheet.sram(queue_uses(config_));
  publish_queues(sheet, passes_, kPasses, "ccus");
  publish_queues(sheet, visible_, kVisible, "ccu.input_slots");
  publish_queues(sheet, converted_, kConverted, "ccu.output_entries");
  // Words of second eyes, each in the cycle behind the first one's.
  const std::uint64_t second_words = lister_.second_eyes_taken();
  sheet.accesses(kConverted, second_words, second_words);
  publish_queues(sheet, requests_, kRequests, "cores");
  publish_queues(sheet, jobs_, kJobs, "sorting.list_buffers");
  publish_queues(sheet, sorted_, kSorted, "rendering.sorted_entries");
  publish_queues(sheet, done_, kDone, "cores");
  sheet.sram_available(kBuffer, config_.sram.buffer_bytes);
}

}  // namespace sgs::gscore

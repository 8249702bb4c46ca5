// Shared units of the two tops.
#include "modules/streaminggs/streaming_machine.h"

#include "modules/streaminggs/filter_cost.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {

StreamingMachine::StreamingMachine(const sc_core::sc_module_name& name,
                                   const StreamingConfig& config, const StreamingJob& job,
                                   const BuiltFor& built_for, const BuildOptions& options)
    : Machine(name),
      config_(config),
      job_(job),
      built_for_(built_for),
      options_(options),
      clock_(config.clock_mhz, options.process_order),
      finished_groups_("finished_groups", clock_, job.groups.size(),
                       config.rendering.feedback_latency_cycles),
      hfus_(config.hfus) {
  for (std::uint32_t h = 0; h < config.hfus; ++h) {
    add_fifo(visits_, fmt::format("visits_to_hfu{}", h), visit_fifos(config));
  }
}

void StreamingMachine::make_units(Construction parts, Rejects rejects, Arrival arrival) {
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    parts.push_back([this, h, rejects] {
      hfus_[h] = std::make_unique<Hfu>(fmt::format("hfu{}", h).c_str(), config_.hfu,
                                       config_.codebook, FineFilterPlace{h, rejects}, context());
    });
  }
  parts.push_back([this, arrival] {
    rendering_ = std::make_unique<RenderingUnit>("rendering", config_.rendering, arrival, context(),
                                                 [this] { finish_frame(); });
  });
  if (job_.layout.second_half.quantised()) {
    parts.push_back([this] {
      codebooks_ = std::make_unique<CodebookBuffer>("codebooks", config_.codebook, context(),
                                                    instant_end(), config_.hfus);
    });
  }
  construct(std::move(parts), options_.process_order);

  rendering_->finish(finished_groups_);
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    hfus_[h]->coarse.shares(*visits_[h]);
    hfus_[h]->coarse.finished(finished_groups_);
    hfus_[h]->fine.finished(finished_groups_);
    if (codebooks_) hfus_[h]->fine.codebooks(*codebooks_);
  }
}

void StreamingMachine::publish(DataSheet& sheet) {
  publish_units(sheet);
  sheet.unit(*this);
  for (const Queue& queue : queues_) {
    sheet.sram(queue.use);
    sheet.queue(*queue.fifo, queue.use.name.c_str());
  }
  sheet.sram_available(kInputSram, config_.sram.input_bytes);
  sheet.sram_available(kCodebookSram, config_.sram.codebook_bytes);
  sheet.sram_available(kSharedSram, config_.sram.shared_bytes);
  publish_filters(sheet, config_.hfu, job_.layout.split.bound_by, job_.layout.sh_degree());
}

}  // namespace sgs

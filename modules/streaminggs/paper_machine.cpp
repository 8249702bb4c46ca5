// Wiring of paper order.
#include "modules/streaminggs/paper_machine.h"

#include <algorithm>

#include "modules/streaminggs/spare_parts.h"

namespace sgs {

PaperMachine::PaperMachine(const sc_core::sc_module_name& name, const PaperConfig& config,
                           const StreamingJob& job, const BuiltFor& built_for,
                           const BuildOptions& options)
    : StreamingMachine(name, config, job, built_for, options,
                       {Rejects::kDropped, Arrival::kByVisit}),
      sorting_(config.sorting),
      vsu_("vsu", config.vsu, context()) {
  add_fifos(config);
  make_sorters(config);
  bind(config.lists_of_part());
  connect_memory(job.frames());
}

void PaperMachine::add_fifos(const PaperConfig& config) {
  const PaperFifos kinds(config);
  for (std::uint32_t h = 0; h < config.fetches(); ++h) {
    add_fifo(candidates_, fmt::format("candidates_of_hfu{}", h), kinds.candidates);
  }
  for (std::uint32_t s = 0; s < config.lists(); ++s) {
    for (std::uint32_t h = 0; h < config.fetches(); ++h) {
      add_fifo(splats_, fmt::format("splats_hfu{}_to_sorting{}", h, s), kinds.splats);
    }
    add_fifo(sorted_, fmt::format("sorted_by_sorting{}", s), kinds.sorted);
  }
}

void PaperMachine::make_sorters(const PaperConfig& config) {
  const RegionSpan& spill = job().spill;
  const std::uint64_t share = spill.bytes / config.lists();
  const std::uint32_t of_part = config.lists_of_part();
  for (std::uint32_t s = 0; s < config.lists(); ++s) {
    const PaperSorterPlace place{s % of_part, of_part, spill.part(s * share, share),
                                 config.lists_of_network()};
    sorters_.push_back(std::make_unique<PaperSorter>(
        fmt::format("sorting{}", s).c_str(), config.sorting, place, part_context(s / of_part)));
  }
}

void PaperMachine::bind(std::uint32_t lists_of_part) {
  vsu_.host(host);
  for (const auto& finished : finished_groups_) vsu_.finished(*finished);
  for (std::size_t h = 0; h < hfus_.size(); ++h) {
    vsu_.shares(*visits_[h]);
    hfus_[h]->coarse.survivors(*candidates_[h]);
    hfus_[h]->fine.candidates(*candidates_[h]);
  }
  for (std::size_t s = 0; s < sorters_.size(); ++s) {
    const std::size_t part = s / lists_of_part;
    for (std::size_t h = 0; h < hfus_.size(); ++h) {
      TimedFifo<SplatToken>& splats = *splats_[s * hfus_.size() + h];
      hfus_[h]->fine.splats(splats);
      sorters_[s]->splats(splats);
    }
    sorters_[s]->finished(*finished_groups_[part]);
    sorters_[s]->sorted(*sorted_[s]);
    rendering_[part]->splats(*sorted_[s]);
  }
}

void PaperMachine::publish_units(DataSheet& sheet) {
  vsu_.publish(sheet);
  if (codebooks_) codebooks_->publish(sheet);
  for (const auto& hfu : hfus_) hfu->publish(sheet);
  for (const auto& sorter : sorters_) sorter->publish(sheet);
  std::uint64_t longest = 0;
  for (const auto& sorter : sorters_)
    longest = std::max<std::uint64_t>(longest, sorter->counters().list_max);
  publish_spare(sheet, "spare_sort_buffer_entries", "sorting.buffer_entries",
                sorting_.buffer_entries, longest, sorting_.least_buffer_entries());
  for (const auto& rendering : rendering_) rendering->publish(sheet);
}

}  // namespace sgs

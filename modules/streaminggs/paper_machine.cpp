// Wiring of paper order.
#include "modules/streaminggs/paper_machine.h"

#include <algorithm>
#include <optional>

#include "modules/streaminggs/spare_parts.h"

namespace sgs {

PaperMachine::PaperMachine(const sc_core::sc_module_name& name, const PaperConfig& config,
                           const StreamingJob& job, const BuiltFor& built_for,
                           const BuildOptions& options)
    : StreamingMachine(name, config, job, built_for, options),
      config_(config),
      sorters_(config.lists()) {
  add_fifos();
  Construction units;
  units.push_back([=] { vsu_ = std::make_unique<PaperVsu>("vsu", config_.vsu, context()); });
  for (std::uint32_t s = 0; s < config.lists(); ++s) {
    units.push_back([=] {
      const RegionSpan& spill = this->job().spill;
      const std::uint64_t share = spill.bytes / config_.lists();
      const std::uint32_t of_part = config_.lists_of_part();
      const PaperSorterPlace place{s % of_part, of_part, spill.part(s * share, share),
                                   config_.lists_of_network()};
      sorters_[s] = std::make_unique<PaperSorter>(
          fmt::format("sorting{}", s).c_str(), config_.sorting, place, part_context(s / of_part));
    });
  }
  make_units(std::move(units), Rejects::kDropped, Arrival::kByVisit);
  bind();
  connect_memory();
}

void PaperMachine::add_fifos() {
  const PaperFifos kinds(config_);
  for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
    add_fifo(candidates_, fmt::format("candidates_of_hfu{}", h), kinds.candidates);
  }
  for (std::uint32_t s = 0; s < config_.lists(); ++s) {
    for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
      add_fifo(splats_, fmt::format("splats_hfu{}_to_sorting{}", h, s), kinds.splats);
    }
    add_fifo(sorted_, fmt::format("sorted_by_sorting{}", s), kinds.sorted);
  }
}

void PaperMachine::bind() {
  for (const auto& finished : finished_groups_) vsu_->finished(*finished);
  for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
    vsu_->shares(*visits_[h]);
    hfus_[h]->coarse.survivors(*candidates_[h]);
    hfus_[h]->fine.candidates(*candidates_[h]);
  }
  for (std::uint32_t s = 0; s < config_.lists(); ++s) {
    const std::uint32_t part = s / config_.lists_of_part();
    for (std::uint32_t h = 0; h < config_.fetches(); ++h) {
      TimedFifo<SplatToken>& splats = *splats_[s * config_.fetches() + h];
      hfus_[h]->fine.splats(splats);
      sorters_[s]->splats(splats);
    }
    sorters_[s]->finished(*finished_groups_[part]);
    sorters_[s]->sorted(*sorted_[s]);
    rendering_[part]->splats(*sorted_[s]);
  }
}

void PaperMachine::publish_units(DataSheet& sheet) {
  vsu_->publish(sheet);
  if (codebooks_) codebooks_->publish(sheet);
  for (const auto& hfu : hfus_) hfu->publish(sheet);
  for (const auto& sorter : sorters_) sorter->publish(sheet);
  std::uint64_t longest = 0;
  for (const auto& sorter : sorters_) longest = std::max(longest, sorter->counters().list_max);
  publish_spare(sheet, "spare_sort_buffer_entries", "sorting.buffer_entries",
                config_.sorting.buffer_entries, longest, config_.sorting.least_buffer_entries());
  for (const auto& rendering : rendering_) rendering->publish(sheet);
}

}  // namespace sgs

// Wiring of paper order.
#include "modules/streaminggs/paper_machine.h"

namespace sgs {

PaperMachine::PaperMachine(const sc_core::sc_module_name& name, const PaperConfig& config,
                           const StreamingJob& job, const BuiltFor& built_for,
                           const BuildOptions& options)
    : StreamingMachine(name, config, job, built_for, options),
      config_(config),
      sorters_(config.sorting_units) {
  add_fifos();
  Construction units;
  units.push_back([=] { vsu_ = std::make_unique<PaperVsu>("vsu", config_.vsu, context()); });
  for (std::uint32_t s = 0; s < config.sorting_units; ++s) {
    units.push_back([=] {
      const RegionSpan& spill = this->job().spill;
      const std::uint64_t share = spill.bytes / config_.sorting_units;
      const PaperSorterPlace place{s, config_.sorting_units, spill.part(s * share, share)};
      sorters_[s] = std::make_unique<PaperSorter>(fmt::format("sorting{}", s).c_str(),
                                                  config_.sorting, place, context());
    });
  }
  make_units(std::move(units), Rejects::kDropped, Arrival::kByVisit);
  bind();
  connect_memory();
}

void PaperMachine::add_fifos() {
  const PaperFifos kinds(config_);
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    add_fifo(candidates_, fmt::format("candidates_of_hfu{}", h), kinds.candidates);
  }
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    for (std::uint32_t h = 0; h < config_.hfus; ++h) {
      add_fifo(splats_, fmt::format("splats_hfu{}_to_sorting{}", h, s), kinds.splats);
    }
    add_fifo(sorted_, fmt::format("sorted_by_sorting{}", s), kinds.sorted);
  }
}

void PaperMachine::bind() {
  vsu_->finished(finished_groups_);
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    vsu_->shares(*visits_[h]);
    hfus_[h]->coarse.survivors(*candidates_[h]);
    hfus_[h]->fine.candidates(*candidates_[h]);
  }
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    for (std::uint32_t h = 0; h < config_.hfus; ++h) {
      TimedFifo<SplatToken>& splats = *splats_[s * config_.hfus + h];
      hfus_[h]->fine.splats(splats);
      sorters_[s]->splats(splats);
    }
    sorters_[s]->finished(finished_groups_);
    sorters_[s]->sorted(*sorted_[s]);
    rendering_->splats(*sorted_[s]);
  }
}

void PaperMachine::publish_units(DataSheet& sheet) {
  vsu_->publish(sheet);
  if (codebooks_) codebooks_->publish(sheet);
  for (const auto& hfu : hfus_) hfu->publish(sheet);
  for (const auto& sorter : sorters_) sorter->publish(sheet);
  rendering_->publish(sheet);
}

}  // namespace sgs

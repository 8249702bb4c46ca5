// Wiring of exact order.
#include "modules/streaminggs/exact_machine.h"

#include <algorithm>
#include <optional>

#include "modules/streaminggs/spare_parts.h"

namespace sgs {
namespace {

std::uint64_t aside_bytes(const ChunkTableLayout& table) {
  return (table.chunk_count + table.nodes.count) * kWalkEntryBytes;
}

}  // namespace

std::uint64_t exact_spill_bytes(const SceneLayout& layout) {
  return aside_bytes(layout.chunk_table()) + 2 * std::uint64_t{layout.gaussian_count()} * kKeyBytes;
}

ExactMachine::ExactMachine(const sc_core::sc_module_name& name, const ExactConfig& config,
                           const StreamingJob& job, const BuiltFor& built_for,
                           const BuildOptions& options)
    : StreamingMachine(name, config, job, built_for, options),
      config_(config),
      sorters_(config.sorting_units),
      finished_subtiles_("finished_subtiles", clock(), job.groups,
                         config.rendering.feedback_latency_cycles),
      untold_("untold_subtiles", clock(), job.groups, config.rendering.feedback_latency_cycles) {
  add_fifos();
  const std::uint64_t aside = aside_bytes(job.layout.chunk_table());
  Construction units;
  units.push_back([=] {
    vsu_ =
        std::make_unique<ExactVsu>("vsu", config_.vsu, context(), this->job().spill.part(0, aside));
  });
  for (std::uint32_t s = 0; s < config.sorting_units; ++s) {
    units.push_back([=] {
      sorters_[s] =
          std::make_unique<ExactSorter>(fmt::format("sorting{}", s).c_str(), config_.sorting, s,
                                        config_.sorting_units, context());
    });
  }
  units.push_back([=] {
    const RegionSpan& spill = this->job().spill;
    merge_ = std::make_unique<MergeUnit>("merge", config_.merge,
                                         spill.part(aside, spill.bytes - aside), context());
  });
  make_units(std::move(units), Rejects::kReported, Arrival::kByToken);
  bind();
  connect_memory();
}

void ExactMachine::add_fifos() {
  const ExactFifos kinds(config_);
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
      add_fifo(keys_, fmt::format("keys_hfu{}_to_sorting{}", h, s), kinds.keys);
    }
    add_fifo(released_, fmt::format("released_to_hfu{}", h), kinds.released);
    add_fifo(splats_, fmt::format("splats_of_hfu{}", h), kinds.splats);
  }
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    add_fifo(sorted_keys_, fmt::format("keys_sorted_by_sorting{}", s), kinds.sorted_keys);
  }
}

void ExactMachine::bind() {
  vsu_->finished(*finished_groups_[0]);
  merge_->finished(*finished_groups_[0]);
  const bool spills = config_.merge.on_overflow == OnOverflow::kSpill;
  vsu_->mask(spills ? finished_subtiles_ : untold_);
  merge_->mask(finished_subtiles_);
  rendering_[0]->finish_subtile(finished_subtiles_);
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    vsu_->visits(*visits_[h]);
    for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
      TimedFifo<FineCandidate>& keys = *keys_[h * config_.sorting_units + s];
      hfus_[h]->coarse.survivors(keys);
      sorters_[s]->keys(keys);
    }
    merge_->released(*released_[h]);
    hfus_[h]->fine.candidates(*released_[h]);
    hfus_[h]->fine.splats(*splats_[h]);
    rendering_[0]->splats(*splats_[h]);
  }
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    sorters_[s]->sorted(*sorted_keys_[s]);
    merge_->sorted(*sorted_keys_[s]);
  }
}

void ExactMachine::publish_units(DataSheet& sheet) {
  vsu_->publish(sheet);
  if (codebooks_) codebooks_->publish(sheet);
  for (const auto& hfu : hfus_) hfu->publish(sheet);
  for (const auto& sorter : sorters_) sorter->publish(sheet);
  const auto sorts = [](const ExactSorter& sorter) { return sorter.counters().keys > 0; };
  publish_spare(sheet, "spare_sorting_units", "sorting_units", sorters_.size(),
                units_fed(sorters_, sorts), 1);
  merge_->publish(sheet);
  rendering_[0]->publish(sheet);
}

}  // namespace sgs

// Wiring of exact order.
#include "modules/streaminggs/exact_machine.h"

#include <algorithm>
#include <optional>

#include "modules/streaminggs/exact_estimate.h"
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

std::uint64_t ExactMachine::estimate(const FrameWork& work, MemoryEstimate& dram) {
  const ExactWork& of = dynamic_cast<const ExactFrameWork&>(work).of;
  const SceneLayout& layout = job().layout;
  const auto port = [&](const auto& unit) { return estimate_of(unit.memory, dram); };
  RenderingEstimate rendering(config_.rendering, job(), port(*rendering_[0]));
  const bool spills = config_.merge.on_overflow == OnOverflow::kSpill;
  std::optional<CodebookEstimate> codebooks;
  if (codebooks_) {
    codebooks.emplace(config_.codebook, layout.second_half, layout.codebooks, port(*codebooks_));
  }
  const std::uint64_t aside = aside_bytes(layout.chunk_table());
  ExactUnitEstimates units{
      {config_.vsu, vsu_->test_lanes(), layout.chunk_table().nodes, of.groups, port(*vsu_),
       [&](const GroupReach& reach, std::uint64_t cycle) {
         return spills && rendering.finished(reach, cycle);
       }},
      {},
      {},
      std::vector<ExactSorterEstimate>(config_.sorting_units, ExactSorterEstimate(config_.sorting)),
      {config_.merge, merge_->heap_entries(), job().spill.part(aside, job().spill.bytes - aside),
       port(*merge_)}};
  for (const auto& hfu : hfus_) {
    units.coarse.emplace_back(config_.hfu, hfu->coarse, layout.first_halves, port(hfu->coarse));
    units.fine.emplace_back(config_.hfu, hfu->fine, layout.second_halves, port(hfu->fine),
                            codebooks ? &*codebooks : nullptr);
  }
  ExactEstimate frame(config_, of, units, rendering);
  const std::uint64_t cycles = frame.draw();

  ExactVsu::Work of_vsu = units.vsu.work();
  of_vsu.walked.node_queue = of.node_queue;
  of_vsu.walked.chunk_queue = of.chunk_queue;
  // The golden walk's queues have no end.
  of_vsu.walked.node_queue_max =
      std::min<std::size_t>(of.node_queue_max, config_.vsu.node_queue_entries);
  of_vsu.walked.chunk_queue_max =
      std::min<std::size_t>(of.chunk_queue_max, config_.vsu.queue_entries);
  vsu_->assume(of_vsu);
  if (codebooks_) codebooks_->assume(codebooks->work());
  for (std::size_t h = 0; h < hfus_.size(); ++h) {
    hfus_[h]->coarse.assume(units.coarse[h].work());
    hfus_[h]->fine.assume(units.fine[h].work());
  }
  for (std::size_t s = 0; s < sorters_.size(); ++s) sorters_[s]->assume(units.sorters[s].work());
  merge_->assume(units.merge.work());
  RenderingUnit::Work of_rendering = rendering.work();
  of_rendering.counters.contributors = of.contributors;
  rendering_[0]->assume(of_rendering);
  (spills ? finished_subtiles_ : untold_).assume(of_rendering.news);
  assume(visits_, frame.visits());
  assume(keys_, frame.keys());
  assume(sorted_keys_, frame.sorted());
  assume(released_, frame.released());
  assume(splats_, frame.splats());
  return cycles;
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

// Wiring of exact order.
#include "modules/streaminggs/exact_machine.h"

#include "modules/streaminggs/spare_parts.h"

namespace sgs {
namespace {

// Bytes at the beginning of the spill region for entries of VSU's queues; runs of keys lie behind
// them.
std::uint64_t aside_bytes(const SceneLayout& layout) {
  const ChunkTableLayout& table = layout.chunk_table();
  return (table.chunk_count + table.nodes.count) * kWalkEntryBytes;
}
RegionSpan behind_aside(const StreamingJob& job) {
  const std::uint64_t aside = aside_bytes(job.layout);
  return job.spill.part(aside, job.spill.bytes - aside);
}

}  // namespace

std::uint64_t exact_spill_bytes(const SceneLayout& layout) {
  return aside_bytes(layout) + 2 * std::uint64_t{layout.gaussian_count()} * kKeyBytes;
}

ExactMachine::ExactMachine(const sc_core::sc_module_name& name, const ExactConfig& config,
                           const StreamingJob& job, const BuiltFor& built_for,
                           const BuildOptions& options)
    : StreamingMachine(name, config, job, built_for, options,
                       {Rejects::kReported, Arrival::kByToken}),
      vsu_("vsu", config.vsu, context(), job.spill.part(0, aside_bytes(job.layout))),
      merge_("merge", config.merge, behind_aside(job), context()),
      untold_("untold_subtiles", clock(), job.groups, config.rendering.feedback_latency_cycles) {
  for (std::uint32_t eye = 0; eye < config.hfu.eyes; ++eye) {
    finished_subtiles_.push_back(
        std::make_unique<FinishedSubtiles>(fmt::format("finished_subtiles{}", eye).c_str(), clock(),
                                           job.groups, config.rendering.feedback_latency_cycles));
  }
  add_fifos(config);
  make_sorters(config);
  bind(config.merge.on_overflow);
  connect_memory(job.frames());
}

void ExactMachine::add_fifos(const ExactConfig& config) {
  const ExactFifos kinds(config);
  for (std::uint32_t h = 0; h < config.hfus; ++h) {
    for (std::uint32_t s = 0; s < config.sorting_units; ++s) {
      add_fifo(keys_, fmt::format("keys_hfu{}_to_sorting{}", h, s), kinds.keys);
    }
    add_fifo(released_, fmt::format("released_to_hfu{}", h), kinds.released);
    for (std::uint32_t eye = 0; eye < config.hfu.eyes; ++eye) {
      const std::string of_eye = config.hfu.eyes > 1 ? fmt::format("_eye{}", eye) : "";
      add_fifo(splats_, fmt::format("splats_of_hfu{}{}", h, of_eye), kinds.splats);
    }
  }
  for (std::uint32_t s = 0; s < config.sorting_units; ++s) {
    add_fifo(sorted_keys_, fmt::format("keys_sorted_by_sorting{}", s), kinds.sorted_keys);
  }
}

void ExactMachine::make_sorters(const ExactConfig& config) {
  for (std::uint32_t s = 0; s < config.sorting_units; ++s) {
    sorters_.push_back(std::make_unique<ExactSorter>(
        fmt::format("sorting{}", s).c_str(), config.sorting, s, config.sorting_units, context()));
  }
}

void ExactMachine::bind(OnOverflow on_overflow) {
  vsu_.host(host);
  for (std::size_t eye = 0; eye < rendering_.size(); ++eye) {
    vsu_.finished(*finished_groups_[eye]);
    merge_.finished(*finished_groups_[eye]);
    vsu_.masks(on_overflow == OnOverflow::kSpill ? *finished_subtiles_[eye] : untold_);
    merge_.masks(*finished_subtiles_[eye]);
    rendering_[eye]->finish_subtile(*finished_subtiles_[eye]);
  }
  for (std::size_t h = 0; h < hfus_.size(); ++h) {
    vsu_.visits(*visits_[h]);
    for (std::size_t s = 0; s < sorters_.size(); ++s) {
      TimedFifo<FineCandidate>& keys = *keys_[h * sorters_.size() + s];
      hfus_[h]->coarse.survivors(keys);
      sorters_[s]->keys(keys);
    }
    merge_.released(*released_[h]);
    hfus_[h]->fine.candidates(*released_[h]);
    for (std::size_t eye = 0; eye < rendering_.size(); ++eye) {
      hfus_[h]->fine.splats(*splats_[h * rendering_.size() + eye]);
      rendering_[eye]->splats(*splats_[h * rendering_.size() + eye]);
    }
  }
  for (std::size_t s = 0; s < sorters_.size(); ++s) {
    sorters_[s]->sorted(*sorted_keys_[s]);
    merge_.sorted(*sorted_keys_[s]);
  }
}

void ExactMachine::publish_units(DataSheet& sheet) {
  vsu_.publish(sheet);
  if (codebooks_) codebooks_->publish(sheet);
  for (const auto& hfu : hfus_) hfu->publish(sheet);
  for (const auto& sorter : sorters_) sorter->publish(sheet);
  const auto sorts = [](const ExactSorter& sorter) { return sorter.counters().keys > 0; };
  publish_spare(sheet, "spare_sorting_units", "sorting_units", sorters_.size(),
                units_fed(sorters_, sorts), 1);
  merge_.publish(sheet);
  for (const auto& rendering : rendering_) rendering->publish(sheet);
}

}  // namespace sgs

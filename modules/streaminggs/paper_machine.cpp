// Wiring of paper order.
#include "modules/streaminggs/paper_machine.h"

#include <algorithm>
#include <optional>

#include "modules/streaminggs/paper_estimate.h"
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

std::uint64_t PaperMachine::estimate(const FrameWork& work, MemoryEstimate& dram) {
  const auto& of = dynamic_cast<const PaperFrameWork&>(work);
  const SceneLayout& layout = job().layout;
  const auto port = [&](const MemoryPort& of_unit) { return estimate_of(of_unit, dram); };
  std::optional<CodebookEstimate> codebooks;
  if (codebooks_) {
    codebooks.emplace(config_.codebook, layout.second_half, layout.codebooks,
                      port(codebooks_->memory));
  }
  PaperVsuEstimate vsu(config_.vsu, context().built_for.single, layout.voxel_table(), of.grid,
                       job().view, {port(vsu_->node_memory), port(vsu_->record_memory)});
  PaperUnitEstimates units{vsu, {}, {}, {}, {}};
  for (const auto& hfu : hfus_) {
    units.coarse.emplace_back(config_.hfu, hfu->coarse, layout.first_halves,
                              port(hfu->coarse.memory));
    units.fine.emplace_back(config_.hfu, hfu->fine, layout.second_halves, port(hfu->fine.memory),
                            codebooks ? &*codebooks : nullptr);
  }
  for (const auto& sorter : sorters_) {
    units.sorters.emplace_back(config_.sorting, sorter->place(), port(sorter->memory));
  }
  for (std::uint32_t p = 0; p < rendering_.size(); ++p) {
    units.rendering.push_back(std::make_unique<RenderingEstimate>(
        rendering_of_part(config_), part_context(p).job, port(rendering_[p]->memory)));
  }
  PaperEstimate frame(config_, job(), of.of, units);
  const std::uint64_t cycles = frame.draw();

  vsu_->assume(vsu.work());
  if (codebooks_) codebooks_->assume(codebooks->work());
  for (std::size_t f = 0; f < hfus_.size(); ++f) {
    hfus_[f]->coarse.assume(units.coarse[f].work());
    hfus_[f]->fine.assume(units.fine[f].work());
  }
  for (std::size_t s = 0; s < sorters_.size(); ++s) sorters_[s]->assume(units.sorters[s].work());
  for (std::size_t p = 0; p < rendering_.size(); ++p) {
    RenderingUnit::Work of_part = units.rendering[p]->work();
    for (const PaperGroupWork& group : of.of.groups) {
      of_part.counters.contributors += group.contributors[p];
    }
    rendering_[p]->assume(of_part);
  }
  assume(visits_, frame.visits());
  assume(candidates_, frame.candidates());
  assume(splats_, frame.splats());
  assume(sorted_, frame.sorted());
  return cycles;
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

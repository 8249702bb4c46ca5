// Wiring of the accelerator.
#include "modules/accelerator.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace sgs {

std::uint64_t spill_region_bytes(const AcceleratorConfig& config, const VoxelGrid& grid) {
  std::uint64_t longest = 0;
  for (const VoxelRecord& voxel : grid.voxels)
    longest = std::max<std::uint64_t>(longest, voxel.count);
  return config.sorting_units * 2 * longest * kSplatEntryBytes;
}

namespace {

std::uint64_t aside_bytes(std::uint64_t chunks, std::uint64_t nodes) {
  return (chunks + nodes) * kWalkEntryBytes;
}

// VSU, HFUs, rendering, whoever spills (the sorting units or the merge unit), the codebook buffer.
std::uint32_t initiators(const AcceleratorConfig& config, const SecondHalfFormat& format) {
  return 2 + config.hfus + (config.ordering == Ordering::kPaper ? config.sorting_units : 1) +
         (format.quantised() ? 1 : 0);
}

}  // namespace

std::uint64_t spill_region_bytes(const ChunkTree& tree) {
  return aside_bytes(tree.chunk_count, tree.nodes.size()) +
         2 * tree.storage_order.size() * kSpilledKeyBytes;
}

Accelerator::Accelerator(const sc_core::sc_module_name& name, const AcceleratorConfig& config,
                         const FrameJob& job, const MemoryImage& image, TimingMode timing,
                         StallInjector* stalls)
    : sc_module(name),
      config_(config),
      job_(job),
      timing_(timing),
      stalls_(stalls),
      clock_(config.clock_mhz),
      board_(job.groups.size()),
      dram_("dram", config.dram),
      router_("router", initiators(config, job.layout.second_half)) {
  router_.map(0, dram_.capacity_bytes(), dram_.socket);
  dram_.load(0, image.bytes.data(), image.bytes.size());
  if (job_.layout.second_half.quantised()) {
    codebooks_ = std::make_unique<CodebookBuffer>("codebooks", config.codebook, clock_, job_,
                                                  add_port("codebooks"));
    if (config.codebook.preloaded) {
      codebooks_->preload(image.bytes.data() + job_.layout[Region::kCodebooks].base);
    }
  }
  if (config.ordering == Ordering::kPaper) {
    add_rendering(wire_paper_order(), Arrival::kByVisit);
  } else {
    add_rendering(wire_exact_order(), Arrival::kByToken);
  }
}

std::vector<TimedFifo<VisitShare>*> Accelerator::add_visit_fifos() {
  std::vector<TimedFifo<VisitShare>*> shares;
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    shares.push_back(
        add_fifo(visit_fifos_, fmt::format("visits_to_hfu{}", h), kVisitFifoEntries, 1));
  }
  return shares;
}

std::vector<TimedFifo<SplatToken>*> Accelerator::wire_paper_order() {
  const std::vector<TimedFifo<VisitShare>*> shares = add_visit_fifos();
  vsu_ = std::make_unique<Vsu>("vsu", config_.vsu, clock_, job_, board_, add_port("vsu"), shares);
  std::vector<std::vector<TimedFifo<SplatToken>*>> to_sorting(config_.sorting_units);
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    for (std::uint32_t h = 0; h < config_.hfus; ++h) {
      to_sorting[s].push_back(add_fifo(splat_fifos_, fmt::format("splats_hfu{}_to_sorting{}", h, s),
                                       config_.sorting.input_fifo_entries,
                                       config_.hfu.ffu_depth_cycles));
    }
  }
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    std::vector<TimedFifo<SplatToken>*> splats;
    for (const auto& inputs : to_sorting) splats.push_back(inputs[h]);
    const std::string hfu = fmt::format("hfu{}", h);
    hfus_.push_back(std::make_unique<Hfu>(hfu.c_str(), config_.hfu, clock_, job_, board_,
                                          add_port(hfu), codebooks_.get(), *shares[h], splats));
  }
  std::vector<TimedFifo<SplatToken>*> sorted;
  const std::uint64_t spill = job_.layout[Region::kSpill].bytes / config_.sorting_units;
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    const std::string unit = fmt::format("sorting{}", s);
    sorted.push_back(add_fifo(sorted_fifos_, fmt::format("sorted_by_{}", unit),
                              config_.rendering.input_fifo_entries, 1));
    const SortingUnit::Place place{s, config_.sorting_units,
                                   job_.layout[Region::kSpill].base + s * spill, spill};
    sorting_.push_back(std::make_unique<SortingUnit>(unit.c_str(), config_.sorting, place, clock_,
                                                     job_, board_, add_port(unit), to_sorting[s],
                                                     *sorted.back()));
  }
  return sorted;
}

std::vector<TimedFifo<SplatToken>*> Accelerator::wire_exact_order() {
  const MemoryLayout& layout = job_.layout;
  const std::uint64_t spill_base = layout[Region::kSpill].base;
  const std::uint64_t aside = aside_bytes(layout.chunk_count, layout.chunk_node_count);
  const std::vector<TimedFifo<VisitShare>*> visits = add_visit_fifos();
  chunk_vsu_ = std::make_unique<ChunkVsu>("vsu", config_.vsu, clock_, job_, board_, add_port("vsu"),
                                          visits, spill_base);
  std::vector<std::vector<TimedFifo<FineCandidate>*>> to_sorting(config_.sorting_units);
  std::vector<TimedFifo<FineCandidate>*> sorted, released;
  std::vector<TimedFifo<SplatToken>*> splats;
  for (std::uint32_t h = 0; h < config_.hfus; ++h) {
    std::vector<TimedFifo<FineCandidate>*> keys;
    for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
      keys.push_back(add_fifo(key_fifos_, fmt::format("keys_hfu{}_to_sorting{}", h, s),
                              config_.hfu.candidate_fifo_entries, config_.hfu.cfu_depth_cycles));
      to_sorting[s].push_back(keys.back());
    }
    released.push_back(add_fifo(key_fifos_, fmt::format("released_to_hfu{}", h),
                                config_.merge.output_fifo_entries, 1));
    splats.push_back(add_fifo(sorted_fifos_, fmt::format("splats_of_hfu{}", h),
                              config_.rendering.input_fifo_entries, config_.hfu.ffu_depth_cycles));
    const std::string hfu = fmt::format("hfu{}", h);
    hfus_.push_back(std::make_unique<Hfu>(hfu.c_str(), config_.hfu, clock_, job_, board_,
                                          add_port(hfu), codebooks_.get(), *visits[h], keys,
                                          *released.back(), *splats.back()));
  }
  for (std::uint32_t s = 0; s < config_.sorting_units; ++s) {
    const std::string unit = fmt::format("sorting{}", s);
    sorted.push_back(add_fifo(key_fifos_, fmt::format("keys_sorted_by_{}", unit),
                              config_.merge.input_fifo_entries, config_.merge.latency_cycles));
    key_sorters_.push_back(std::make_unique<KeySorter>(unit.c_str(), config_.sorting, s,
                                                       config_.sorting_units, clock_, to_sorting[s],
                                                       *sorted.back()));
  }
  merge_ = std::make_unique<MergeUnit>("merge", config_.merge, clock_, job_, board_,
                                       add_port("merge"), sorted, released, spill_base + aside,
                                       layout[Region::kSpill].bytes - aside);
  return splats;
}

void Accelerator::add_rendering(const std::vector<TimedFifo<SplatToken>*>& splats,
                                Arrival arrival) {
  rendering_ = std::make_unique<RenderingUnit>("rendering", config_.rendering, clock_, job_, board_,
                                               add_port("rendering"), splats, arrival,
                                               [this] { done_ = true; });
}

MemoryPort& Accelerator::add_port(const std::string& name) {
  const auto requester = static_cast<std::uint8_t>(ports_.size());
  const MemoryPort::Config port{requester, config_.memory_port.max_transaction_bytes,
                                config_.memory_port.max_outstanding, timing_};
  ports_.push_back(std::make_unique<MemoryPort>((name + "_port").c_str(), port, pool_));
  ports_.back()->socket.bind(router_.from_initiators[requester]);
  requesters_.push_back(name);
  return *ports_.back();
}

template <class T>
TimedFifo<T>* Accelerator::add_fifo(std::deque<TimedFifo<T>>& fifos, const std::string& name,
                                    std::uint32_t entries, std::uint32_t latency_cycles) {
  fifos.emplace_back(std::string(this->name()) + "." + name, clock_, entries, latency_cycles);
  fifos.back().inject(stalls_);
  return &fifos.back();
}

void Accelerator::run() {
  // Until nothing can happen any more: the frame ends when its last posted write is in the memory.
  sc_core::sc_start();
  if (!done_) {
    throw std::runtime_error("the simulation ran out of events before the frame was finished");
  }
  frame_cycles_ = clock_.now_cycles();
  for (Activity* activity : activities()) activity->close();
}

std::vector<std::byte> Accelerator::read_frame() const {
  std::vector<std::byte> bytes(job_.layout[Region::kFrameBuffer].bytes);
  dram_.read_back(job_.layout[Region::kFrameBuffer].base, bytes.data(), bytes.size());
  return bytes;
}

std::vector<Activity*> Accelerator::activities() {
  std::vector<Activity*> all;
  const auto add = [&](const auto& of_unit) {
    all.insert(all.end(), of_unit.begin(), of_unit.end());
  };
  if (vsu_) add(vsu_->activities());
  if (chunk_vsu_) add(chunk_vsu_->activities());
  if (codebooks_) all.push_back(&codebooks_->load_activity());
  for (auto& hfu : hfus_) add(hfu->activities());
  for (auto& unit : sorting_) all.push_back(&unit->activity());
  for (auto& unit : key_sorters_) all.push_back(&unit->activity());
  if (merge_) all.push_back(&merge_->activity());
  add(rendering_->activities());
  return all;
}

bool Accelerator::drained() const {
  const auto empty = [](const auto& fifos) {
    return std::all_of(fifos.begin(), fifos.end(), [](const auto& f) { return f.empty(); });
  };
  return empty(visit_fifos_) && empty(key_fifos_) && empty(splat_fifos_) && empty(sorted_fifos_) &&
         dram_.idle() &&
         std::all_of(ports_.begin(), ports_.end(), [](const auto& port) { return port->idle(); });
}

void Accelerator::trace(sc_core::sc_trace_file* file) const {
  if (vsu_) vsu_->trace(file);
  if (chunk_vsu_) chunk_vsu_->trace(file);
  if (codebooks_) codebooks_->trace(file);
  for (const auto& hfu : hfus_) hfu->trace(file);
  for (const auto& unit : sorting_) unit->trace(file);
  for (const auto& unit : key_sorters_) unit->trace(file);
  if (merge_) merge_->trace(file);
  rendering_->trace(file);
  for (const auto& port : ports_) port->trace(file);
  dram_.trace(file, timing_);
  for (const auto& fifo : visit_fifos_) fifo.trace(file);
  for (const auto& fifo : key_fifos_) fifo.trace(file);
  for (const auto& fifo : splat_fifos_) fifo.trace(file);
  for (const auto& fifo : sorted_fifos_) fifo.trace(file);
}

}  // namespace sgs

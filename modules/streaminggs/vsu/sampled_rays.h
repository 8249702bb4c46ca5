// The rays of a group one after another, sampled at a fixed distance (StreamingGS, DAC 2025): the
// cells of samples have numbers, the renaming table says which of these are voxels, the ordering
// table and the adjacency table take them.
// Timing: a pipeline that stands still where a later stage does. Samples leave the sampler
// samples_per_cycle a cycle, all of one ray. A new cell takes a look-up a cycle, a voxel an access
// for each slot of its name or line of its source. What a table has not on chip is waited for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "algorithm/voxel/cell_samples.h"
#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/streaming_job.h"
#include "modules/streaminggs/vsu/adjacency_cache.h"
#include "modules/streaminggs/vsu/ray_unit.h"
#include "modules/streaminggs/vsu/table_cache.h"

namespace sgs {

class SampledRays {
 public:
  // From a voxel's look-up to its words in the tables: slot, record and line, write.
  static constexpr std::uint64_t kTableStages = 3;
  static constexpr std::array<const char*, 5> kMayHelp = {"vsu.samples_per_cycle", "vsu.ray_lanes",
                                                          "vsu.renaming_bytes",
                                                          "vsu.adjacency_lines", "vsu.table_bytes"};

  // Adds to the job what it needs: the renaming table of the grid, and a region for edges. Throws
  // InputError where the grid has too many cells, or a ray too many samples.
  static void place_tables(const PaperVsuConfig& config, const VoxelGrid& grid, FrameJob& job);

  // activity, port and job outlive it.
  SampledRays(const PaperVsuConfig& config, const OperationLatencies& latencies, Activity& activity,
              MemoryPort& port, const StreamingJob& job, ListsOut lists);

  // From where the rays of a frame come. view: outlives them.
  void take_up_view(const View<float>& view);

  // What group_visits() asks of rays.
  bool follow(const PixelRect& group, VisitWindow& window, OrderingTable& table, GroupVisits& out);
  void ordered(const std::vector<std::uint32_t>& voxels, const OrderingTable& table, bool last);

  static SramUses sram_uses(const PaperVsuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet) const;
  // Parameters that let the rays of a frame be followed faster, and have less read for them.
  Remedy remedy() const;
  Remedy remedy_of_reads() const;

 private:
  struct Pass {
    VisitWindow& window;
    OrderingTable& table;
    GroupVisits& out;
    OrderingTable::Chain chain = {};  // of the ray
    bool fits = true;
  };
  // A cell in which a ray has a sample and had none.
  struct Cell {
    std::uint64_t number;
    std::uint32_t from_eye;
  };
  // Operations and accesses of a frame.
  struct Counts {
    std::uint64_t rays = 0, samples = 0, beats = 0, cells = 0, met = 0, entered = 0;
    std::uint64_t lines_read = 0, lines_written = 0;
    std::uint64_t names_cleared = 0, ready_cleared = 0;  // words
    std::uint64_t tags_freed = 0;                        // tags of lines
    OrderingAccesses accesses;                           // accesses to the table so far
  };

  std::uint64_t now() const { return activity_.clock().now_cycles(); }
  void advance_to(std::uint64_t cycle);
  void begin_pass();
  void follow_ray(const Ray& ray, Pass& pass);
  std::uint64_t begin_ray();
  bool take_beat(CellSamples<>& samples, const VisitWindow& window, glm::ivec3& before,
                 std::vector<Cell>& cells);
  std::uint64_t look_up(const Cell& cell, std::uint64_t cycle, Pass& pass);
  RenamingLine line(std::uint32_t index, std::uint64_t& cycle);
  void enter(std::uint32_t voxel, std::uint64_t cycle, Pass& pass);
  std::uint64_t use_lines(std::uint32_t source, std::uint64_t cycle, const OrderingTable& table);
  std::uint32_t lines_of(const OrderingTable& table, std::uint32_t source) const;
  std::vector<std::uint32_t> line_of(const OrderingTable& table, std::uint32_t source,
                                     std::uint32_t line) const;
  void clear(const OrderingTable& table);

  const PaperVsuConfig config_;
  const StreamingJob& job_;
  Activity& activity_;
  MemoryPort& port_;
  const ListsOut lists_;
  const Datapath begins_, samples_;
  SampleSpace space_{};
  const View<float>* view_ = nullptr;
  TableCache<RenamingLine> renaming_;
  AdjacencyCache adjacency_;
  // Cycles from which each stage is free again.
  std::uint64_t pass_from_ = 0, begins_free_ = 0, sampler_free_ = 0, look_up_free_ = 0,
                table_free_ = 0, written_ = 0;
  std::vector<std::uint64_t> places_free_;  // [rays_in_flight] of rays that have begun, in turn
  std::uint64_t ray_of_pass_ = 0;
  Counts counts_;
};

}  // namespace sgs

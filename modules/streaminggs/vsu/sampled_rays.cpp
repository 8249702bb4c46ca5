// The stages of a sampling VSU, one behind the other.
#include "modules/streaminggs/vsu/sampled_rays.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {

void SampledRays::place_tables(const PaperVsuConfig& config, const VoxelGrid& grid, FrameJob& job) {
  const RenamingTable table = renaming_table(grid, config.renaming);
  RenamingPlace& place = job.renaming;
  place.cells = occupied_cells(grid);
  // Refused here, ahead of what is built and drawn.
  sample_space(job.view.position, grid.frame, place.cells, config.rays().sample_step_voxels,
               config.rays().sample_far_voxels);
  place.numbers = table.numbers;
  place.look_up = table.look_up;
  place.records =
      job.layout.regions.add_records("renaming_table", sizeof(RenamingLine), table.look_up.lines);
  std::vector<std::byte> bytes(place.records.bytes());
  std::memcpy(bytes.data(), table.lines.data(), bytes.size());
  place.contents = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  job.adjacency = job.layout.regions.add("adjacency", AdjacencyCache::area_bytes(config));
}

SampledRays::SampledRays(const PaperVsuConfig& config, const OperationLatencies& latencies,
                         Activity& activity, MemoryPort& port, const StreamingJob& job,
                         ListsOut lists)
    : config_(config),
      job_(job),
      activity_(activity),
      port_(port),
      lists_(std::move(lists)),
      begins_(sampled_ray_pipeline(config, latencies)),
      samples_(ray_sample_pipeline(config, latencies)),
      renaming_(config.renaming_bytes, job.renaming.records),
      adjacency_(config, job.adjacency) {}

void SampledRays::take_up_view(const View<float>& view) {
  view_ = &view;
  space_ = sample_space(view.position, job_.layout.voxel_table().frame, job_.renaming.cells,
                        config_.rays().sample_step_voxels, config_.rays().sample_far_voxels);
}

void SampledRays::advance_to(std::uint64_t cycle) {
  if (cycle > now()) activity_.clock().wait_cycles(cycle - now());
}

void SampledRays::begin_pass() {
  activity_.works();
  pass_from_ = begins_free_ = sampler_free_ = look_up_free_ = table_free_ = written_ = now();
  places_free_.assign(config_.rays_in_flight, now());
  ray_of_pass_ = 0;
}

bool SampledRays::follow(const PixelRect& group, VisitWindow& window, OrderingTable& table,
                         GroupVisits& out) {
  Pass pass{window, table, out};
  begin_pass();
  for (RayPixels at(group, config_.ray_step_px); !at.done() && pass.fits; at.next()) {
    follow_ray(pixel_ray(*view_, at.x(), at.y()), pass);
  }
  const std::uint64_t entered = table_free_ + kTableStages - 1;
  advance_to(pass.fits ? std::max({sampler_free_, look_up_free_, entered}) : entered);
  if (!pass.fits) clear(table);
  return pass.fits;
}

// The cycle in which its first samples can leave the sampler. It begins when the ray that had its
// place has been sampled.
std::uint64_t SampledRays::begin_ray() {
  ++counts_.rays;
  const std::uint64_t interval = begins_.interval_cycles();
  const std::uint64_t from =
      std::max(begins_free_, places_free_[ray_of_pass_ % places_free_.size()]);
  const std::uint64_t began = pass_from_ + next_turn(from - pass_from_, interval);
  begins_free_ = began + interval;
  return began + config_.ray_depth_cycles + config_.step_depth_cycles;
}

void SampledRays::follow_ray(const Ray& ray, Pass& pass) {
  CellSamples<> samples(space_);
  samples.begin(ray.direction);
  ++pass.out.rays;
  pass.chain = {};
  glm::ivec3 before(-1);
  std::vector<Cell> cells;
  const std::uint64_t samples_before = counts_.samples;
  std::uint64_t cycle = std::max(sampler_free_, begin_ray());
  for (bool more = true; more && pass.fits;) {
    more = take_beat(samples, pass.window, before, cells);
    ++counts_.beats;
    sampler_free_ = cycle + 1;
    for (const Cell& cell : cells) {
      if (!pass.fits) break;
      // The next samples leave when the last cell of these is being looked up.
      sampler_free_ = std::max(sampler_free_, look_up(cell, cycle + 1, pass));
    }
    places_free_[ray_of_pass_ % places_free_.size()] = cycle + 1;
    cycle = sampler_free_;
  }
  // A ray that takes none has looked for one.
  pass.out.steps += std::max<std::uint64_t>(1, counts_.samples - samples_before);
  ++ray_of_pass_;
}

// Samples of a cycle: finds the cells that are new. False where they were the ray's last, or all
// that follow lie behind the window.
bool SampledRays::take_beat(CellSamples<>& samples, const VisitWindow& window, glm::ivec3& before,
                            std::vector<Cell>& cells) {
  cells.clear();
  for (std::uint32_t k = 0; k < config_.samples_per_cycle && !samples.done(); ++k) {
    glm::ivec3 cell;
    ++counts_.samples;
    const bool inside = samples.find_cell(cell);
    samples.next();
    if (!inside || cell == before) continue;
    before = cell;
    const std::uint32_t from_eye = samples.cells_from_eye(cell);
    if (window.behind(VisitWindow::place(0, from_eye))) return false;
    cells.push_back({job_.renaming.numbers.of(cell), from_eye});
  }
  return !samples.done();
}

// Looks the cell up, from this cycle on at the earliest, and enters its voxel if it is one. Returns
// the cycle in which the look-up began.
std::uint64_t SampledRays::look_up(const Cell& cell, std::uint64_t cycle, Pass& pass) {
  ++counts_.cells;
  const RenamingLookUp& table = job_.renaming.look_up;
  cycle = std::max({cycle, look_up_free_, now()});
  const std::uint64_t began = cycle;
  Renamed renamed{Renamed::What::kLookOn};
  for (std::uint32_t at = table.first(cell.number); renamed.what == Renamed::What::kLookOn;
       at = table.behind(at)) {
    renamed = table.read(cell.number, line(at, cycle));
    ++cycle;
  }
  look_up_free_ = cycle;
  if (renamed.what == Renamed::What::kEmpty) return began;
  ++counts_.met;
  const std::uint64_t place = VisitWindow::place(renamed.voxel, cell.from_eye);
  if (pass.window.behind(place) || pass.window.before(place)) return began;
  pass.window.meet(place);
  enter(renamed.voxel, std::max(cycle, table_free_), pass);
  return began;
}

// The line, and the cycle in which it is there.
RenamingLine SampledRays::line(std::uint32_t index, std::uint64_t& cycle) {
  if (const auto* const there = renaming_.find(index)) return renaming_.record_in(*there, index);
  advance_to(cycle);
  TableCache<RenamingLine>::Line come;
  await(port_, activity_, renaming_.fetch(renaming_.line_of(index), come, port_, activity_));
  renaming_.fill(come);
  cycle = now();
  return renaming_.record_in(come, index);
}

// Takes the voxel into the tables from this cycle on. The look-ups go on in the cycle of the last
// access to a line: one that waits for memory holds them up.
void SampledRays::enter(std::uint32_t voxel, std::uint64_t cycle, Pass& pass) {
  ++counts_.entered;
  const bool follows = pass.chain.begun();
  const std::uint32_t source = follows ? pass.chain.number() : 0;
  const OrderingAccesses before = counts_.accesses;
  pass.fits = pass.table.add(pass.chain, voxel);
  counts_.accesses = pass.table.accesses();
  const std::uint64_t slots = counts_.accesses.names_read - before.names_read;
  std::uint64_t last_line = cycle;
  if (follows && pass.fits) last_line = use_lines(source, cycle, pass.table);
  look_up_free_ = std::max(look_up_free_, last_line);
  table_free_ = std::max({cycle + slots, last_line + 1, written_});
  written_ = table_free_ +
             std::max<std::uint64_t>(pass.table.written().size(), pass.table.ready_written());
}

// All lines of a source one a cycle; the last one takes an edge that is new. Returns the cycle of
// the last access.
std::uint64_t SampledRays::use_lines(std::uint32_t source, std::uint64_t cycle,
                                     const OrderingTable& table) {
  const std::uint32_t last = lines_of(table, source) - 1;
  for (std::uint32_t line = 0; line <= last; ++line) {
    cycle += line > 0 ? 1 : 0;
    ++counts_.lines_read;
    if (adjacency_.holds(source, line)) continue;
    advance_to(cycle);
    std::vector<std::uint32_t> values = line_of(table, source, line);
    if (line == last && table.added_edge()) values.pop_back();
    adjacency_.bring(source, line, values, port_, activity_);
    cycle = std::max(cycle, now());
  }
  if (table.added_edge()) {
    ++counts_.lines_written;
    adjacency_.change(source, last, line_of(table, source, last));
  }
  return cycle;
}

std::uint32_t SampledRays::lines_of(const OrderingTable& table, std::uint32_t source) const {
  return static_cast<std::uint32_t>(
      cycles_for(table.out_degree(source), config_.adjacency_destinations));
}

std::vector<std::uint32_t> SampledRays::line_of(const OrderingTable& table, std::uint32_t source,
                                                std::uint32_t line) const {
  const std::vector<std::uint32_t> all = table.destinations(source);
  const std::size_t first = std::size_t{line} * config_.adjacency_destinations;
  const std::size_t end = std::min<std::size_t>(all.size(), first + config_.adjacency_destinations);
  return {all.begin() + static_cast<std::ptrdiff_t>(first),
          all.begin() + static_cast<std::ptrdiff_t>(end)};
}

// A level of ready voxels a cycle, then the voxel's record, its lines, and for each edge the record
// that it leads to. Names are cleared meanwhile. Each line is read for the last time, and its tag
// freed beside: so all places are free for the next pass.
void SampledRays::ordered(const std::vector<std::uint32_t>& voxels, const OrderingTable& table,
                          bool last) {
  lists_.wait_for_room();
  counts_.accesses = table.accesses();
  const std::uint64_t clearing = names_bytes(config_) / kNamesWord;
  counts_.names_cleared += clearing;
  const std::uint64_t from = now();
  std::uint64_t cycles = 0;
  for (std::uint32_t number = 0; number < table.voxel_count(); ++number) {
    const std::uint32_t lines = lines_of(table, number);
    cycles += table.ready_levels() + 1 + lines + table.out_degree(number);
    counts_.lines_read += lines;
    for (std::uint32_t line = 0; line < lines; ++line) {
      if (adjacency_.holds(number, line)) {
        adjacency_.free(number, line);
        ++counts_.tags_freed;
        continue;
      }
      activity_.work(std::exchange(cycles, 0));
      adjacency_.read_back(number, line, line_of(table, number, line), port_, activity_);
    }
  }
  activity_.work(cycles);
  activity_.work(clearing - std::min(clearing, now() - from));
  lists_.hand_over(voxels, last);
}

void SampledRays::clear(const OrderingTable& table) {
  counts_.accesses = table.accesses();
  const std::uint64_t names = names_bytes(config_) / kNamesWord, ready = ready_words(config_),
                      tags = config_.adjacency_lines;
  counts_.names_cleared += names;
  counts_.ready_cleared += ready;
  counts_.tags_freed += tags;
  adjacency_.clear();
  activity_.work(std::max({names, ready, tags}));
}

}  // namespace sgs

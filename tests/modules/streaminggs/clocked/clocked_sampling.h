// Sampled rays of VSU of paper order register by register: a ray that has begun and is sampled,
// cells that wait to be looked up, a voxel that waits to be entered; and the tables, whose slots
// and lines are read a cycle each. What is not on chip comes through one port, and holds up the
// stages before it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "algorithm/voxel/cell_samples.h"
#include "algorithm/voxel/renaming_table.h"
#include "tests/modules/streaminggs/clocked/clocked_cache.h"

namespace sgs::test {

struct SamplingHardware {
  std::uint32_t samples = 1;  // a cycle
  std::uint32_t rays = 16;    // begun at a time
  std::uint32_t ray_step_px = 2;
  std::uint32_t begin_lanes = 8, begin_macs = 0;  // a ray begins in its turn on them
  std::uint32_t begin_cycles = 100, sample_cycles = 9;
  std::uint32_t renaming_bytes = 8192;
  float step_voxels = 0.5F, far_voxels = 0;
  std::uint32_t lines = 256, destinations = 7;
};

// The tables: each voxel's slots, its source's lines, and the order in the end.
class ClockedSampledTable {
 public:
  ClockedSampledTable(const SamplingHardware& hw, const PortHardware& port, std::size_t voxels,
                      std::uint64_t bytes)
      : hw_(hw),
        bytes_(bytes),
        held_(std::max<std::uint64_t>(1, std::min<std::uint64_t>(voxels, bytes / 8))),
        port_(port) {
    free_tags();
    clear();
  }

  ClockedPort& port() { return port_; }
  void begin_cycle() { port_.begin_cycle(); }

  void clear() {
    slots_.assign(Renaming::slots_for(held_), kNone);
    voxels_.clear();
    ready_ = ReadyVoxels(held_);
    writes_ = 0;
    fits_ = true;
  }
  // Frees the places of a pass that is given up; the cycles that it takes.
  std::uint64_t free_tags() {
    places_.assign(hw_.lines, Place());
    return hw_.lines;
  }
  bool fits() const { return fits_; }
  bool idle() const { return doing_ == Doing::kNothing; }
  // Another cell may be looked up: no line is read in this cycle or later.
  bool has_read_lines() const { return line_ >= lines_; }
  std::uint32_t number() const { return number_; }
  static constexpr std::uint32_t kNone = ~0U;

  // The first accesses are of this cycle.
  void begin_add(std::uint32_t from, std::uint32_t voxel) {
    from_ = from;
    voxel_ = voxel;
    slot_ = hash(voxel);
    number_ = kNone;
    find(voxel);
    line_ = 0;
    lines_ = from == kNone || !fits_ ? 0 : lines_of(from);
    doing_ = Doing::kAdd;
  }
  void begin_order() {
    order_.clear();
    next_ready();
  }
  const std::vector<std::uint32_t>& ordered() const { return order_; }

  void step() {
    writes_ -= writes_ > 0 ? 1 : 0;
    if (doing_ == Doing::kAdd) add();
    if (doing_ == Doing::kOrder) order();
  }

 private:
  enum class Doing { kNothing, kAdd, kOrder };
  struct Voxel {
    std::uint32_t id, in_degree = 0;
    std::vector<std::uint32_t> to;
  };
  struct Place {
    std::uint32_t source = kNone, line = 0;
    bool changed = false;
  };
  enum class Fetch { kNone, kWrite, kSettle, kRead, kWait };

  std::uint32_t hash(std::uint32_t voxel) const {
    voxel ^= voxel << 13U;
    voxel ^= voxel >> 17U;
    voxel ^= voxel << 5U;
    return static_cast<std::uint32_t>(voxel & (slots_.size() - 1));
  }
  std::uint32_t lines_of(std::uint32_t source) const {
    return static_cast<std::uint32_t>((voxels_[source].to.size() + hw_.destinations - 1) /
                                      hw_.destinations);
  }
  Place& place(std::uint32_t source, std::uint32_t line) {
    return places_[(source + std::size_t{hw_.lines / 8} * line) % hw_.lines];
  }
  std::uint64_t line_bytes() const { return 2 * hw_.destinations; }
  ClockedTransfer transfer(std::uint32_t source, std::uint32_t line) const {
    std::uint64_t apart = 2;
    while (apart < line_bytes()) apart *= 2;
    return {(std::uint64_t{source} * 8 + line) * apart, line_bytes()};
  }

  // What the accesses will find; the time that they take is that of add().
  void find(std::uint32_t voxel) {
    slots_left_ = 1;
    is_new_ = added_ = false;
    ready_words_ = 0;
    while (slots_[slot_] != kNone && voxels_[slots_[slot_]].id != voxel) {
      slot_ = static_cast<std::uint32_t>((slot_ + 1) & (slots_.size() - 1));
      ++slots_left_;
    }
    number_ = slots_[slot_];
    if (number_ == kNone) {
      number_ = static_cast<std::uint32_t>(voxels_.size());
      is_new_ = true;
      voxels_.push_back({voxel, 0, {}});
      fits_ = voxels_.size() * 8 <= bytes_;
      if (!fits_) return;
      slots_[slot_] = number_;
      if (from_ == kNone) ready_words_ += ready_.set(number_);
    }
    if (from_ == kNone) return;
    std::vector<std::uint32_t>& to = voxels_[from_].to;
    if (std::find(to.begin(), to.end(), number_) != to.end()) return;
    to.push_back(number_);
    added_ = true;
    fits_ = to.size() <= 8 * hw_.destinations;
    if (voxels_[number_].in_degree++ == 0 && !is_new_) ready_words_ += ready_.clear(number_);
  }

  // A slot and a line a cycle, side by side.
  void add() {
    slots_left_ -= slots_left_ > 0 ? 1 : 0;
    if (line_ < lines_ && line_is_there()) {
      if (++line_ == lines_ && added_) place(from_, lines_ - 1).changed = true;
    }
    if (slots_left_ > 0 || line_ < lines_) return;
    if (writes_ > 0) return;
    const bool begins_line = added_ && begins();
    writes_ =
        std::max<std::uint64_t>((is_new_ || added_ ? 1 : 0) + (begins_line ? 1 : 0), ready_words_);
    doing_ = Doing::kNothing;
  }
  // Whether the last edge of the source began a line, so that its record has one more.
  bool begins() const { return (voxels_[from_].to.size() - 1) % hw_.destinations == 0; }
  // Brings the line: who has its place goes first.
  bool line_is_there() {
    Place& at = place(from_, line_);
    if (fetch_ == Fetch::kNone) {
      if (at.source == from_ && at.line == line_) return true;
      reads_ = !(line_ + 1 == lines_ && added_ && begins());
      fetch_ = at.source != kNone && at.changed ? Fetch::kWrite : Fetch::kSettle;
      if (fetch_ == Fetch::kWrite) moved_ = transfer(at.source, at.line);
    }
    if (!moves(transfer(from_, line_))) return false;
    at = {from_, line_, false};
    return true;
  }
  // The steps of fetch_, as far as they go in this cycle.
  bool moves(const ClockedTransfer& line) {
    if (fetch_ == Fetch::kWrite) {
      if (!port_.write(moved_)) return false;
      fetch_ = Fetch::kSettle;
    }
    if (fetch_ == Fetch::kSettle) {
      if (reads_ && !port_.idle()) return false;
      fetch_ = reads_ ? Fetch::kRead : Fetch::kNone;
      moved_ = line;
    }
    if (fetch_ == Fetch::kRead) {
      if (!port_.read(moved_)) return false;
      fetch_ = Fetch::kWait;
    }
    if (fetch_ == Fetch::kWait) {
      if (!port_.answered(moved_)) return false;
      fetch_ = Fetch::kNone;
    }
    return true;
  }

  void next_ready() {
    doing_ = ready_.empty() ? Doing::kNothing : Doing::kOrder;
    left_ = ready_.levels() + 1;
    line_ = lines_ = 0;
  }
  // A word of each level and the record, then the lines, then the records that edges lead to.
  void order() {
    if (left_ > 0) {
      if (--left_ > 0) return;
      number_ = ready_.first();
      ready_.clear(number_);
      order_.push_back(voxels_[number_].id);
      lines_ = lines_of(number_);
      edges_left_ = voxels_[number_].to.size();
      if (lines_ == 0) next_ready();
      return;
    }
    if (line_ < lines_) {
      Place& at = place(number_, line_);
      if (at.source == number_ && at.line == line_) {
        at = Place();  // it is wanted no more
      } else if (fetch_ == Fetch::kNone) {
        reads_ = true;
        fetch_ = Fetch::kSettle;
      }
      if (fetch_ != Fetch::kNone && !moves(transfer(number_, line_))) return;
      ++line_;
      return;
    }
    if (--edges_left_ > 0) return;
    for (const std::uint32_t to : voxels_[number_].to) {
      if (--voxels_[to].in_degree == 0) ready_.set(to);
    }
    next_ready();
  }

  const SamplingHardware hw_;
  const std::uint64_t bytes_, held_;
  ClockedPort port_;
  std::vector<std::uint32_t> slots_;
  std::vector<Voxel> voxels_;
  std::vector<Place> places_;
  ReadyVoxels ready_{1};
  std::uint64_t writes_ = 0, ready_words_ = 0;
  bool fits_ = true, is_new_ = false, added_ = false, reads_ = false;
  Doing doing_ = Doing::kNothing;
  Fetch fetch_ = Fetch::kNone;
  ClockedTransfer moved_;
  std::uint32_t from_ = kNone, voxel_ = 0, number_ = kNone, slot_ = 0;
  std::uint32_t slots_left_ = 0, line_ = 0, lines_ = 0, left_ = 0;
  std::size_t edges_left_ = 0;
  std::vector<std::uint32_t> order_;
};

class ClockedSampling {
 public:
  // Bytes of the renaming table lie from `base` on.
  ClockedSampling(const SamplingHardware& hw, const View<float>& view, const VoxelGrid& grid,
                  std::uint64_t base)
      : hw_(hw),
        view_(view),
        table_(renaming_table(grid, RenamingForm::kHashed)),
        base_(base),
        space_(sample_space(view.position, grid.frame, occupied_cells(grid), hw.step_voxels,
                            hw.far_voxels)),
        cache_(hw.renaming_bytes) {}

  // All is free and the tables empty; the first ray begins in this cycle.
  void begin(const PixelRect& group, const VisitWindow& window) {
    pixels_.emplace(group, hw_.ray_step_px);
    window_ = window;
    since_ = last_work_ = 0;
    begun_.clear();
    cells_.clear();
    found_.reset();
    looks_up_ = misses_ = ended_ = overflows_ = false;
    chain_ = ClockedSampledTable::kNone;
  }
  const VisitWindow& window() const { return window_; }
  bool gives_up() const { return overflows_ && ended_; }
  bool done() const { return !overflows_ && ended_; }
  // Lines are waited for where they are asked for.
  bool waits_for_lines() const { return false; }
  void wait_for_lines() {}

  void step(ClockedSampledTable& table) {
    constexpr std::uint64_t kToTheLastStage = 3;
    const bool empty = overflows_ || (pixels_->done() && begun_.empty() && cells_.empty() &&
                                      !looks_up_ && !found_);
    if (empty && table.idle() && since_ >= last_work_ + kToTheLastStage) {
      ended_ = true;
      return;
    }
    enter(table);
    if (!overflows_) {
      look_up(table);
      begin_ray();
      sample();
    }
    ++since_;
  }

 private:
  struct Begun {
    std::uint64_t due;
    CellSamples<> samples;
    glm::ivec3 before{-1};
  };
  struct Cell {
    std::uint64_t number;
    std::uint32_t from_eye;
    std::uint64_t ray;
  };
  struct Found {
    std::uint32_t voxel;
    std::uint64_t ray;
  };

  // The tables take what was found in an earlier cycle, and go on with what they have.
  void enter(ClockedSampledTable& table) {
    if (table.idle() && found_) {
      if (found_->ray != ray_of_chain_) chain_ = ClockedSampledTable::kNone;
      table.begin_add(chain_, found_->voxel);
      chain_ = table.number();
      ray_of_chain_ = found_->ray;
      overflows_ = !table.fits();
      found_.reset();
    }
    if (!table.idle()) last_work_ = since_;
    table.step();
  }

  void look_up(ClockedSampledTable& table) {
    if (!looks_up_) {
      if (cells_.empty() || found_ || !table.has_read_lines()) return;
      looked_up_ = cells_.front();
      cells_.pop_front();
      record_ = table_.look_up.first(looked_up_.number);
      looks_up_ = true;
    }
    const std::uint64_t line = (base_ + record_ * sizeof(RenamingLine)) / ClockedCache::kLineBytes;
    if (misses_ ? !table.port().answered(line_) : !cache_.hits(line)) {
      if (!misses_) line_ = {line * ClockedCache::kLineBytes, 1};
      misses_ = true;
      table.port().read(line_);
      return;
    }
    if (misses_) cache_.fill(line);
    misses_ = false;
    const Renamed renamed = table_.look_up.read(looked_up_.number, table_.lines[record_]);
    if (renamed.what == Renamed::What::kLookOn) {
      record_ = table_.look_up.behind(record_);
      return;
    }
    looks_up_ = false;
    if (renamed.what == Renamed::What::kEmpty) return;
    const std::uint64_t place = VisitWindow::place(renamed.voxel, looked_up_.from_eye);
    if (window_.behind(place) || window_.before(place)) return;
    window_.meet(place);
    found_ = {renamed.voxel, looked_up_.ray};
  }

  std::uint32_t begin_turn() const {
    return (hw_.begin_macs + hw_.begin_lanes - 1) / hw_.begin_lanes;
  }
  // One that has been sampled leaves its place in the next cycle.
  void begin_ray() {
    if (pixels_->done() || begun_.size() == hw_.rays || since_ % begin_turn() != 0) return;
    Begun ray{since_ + hw_.begin_cycles + hw_.sample_cycles, CellSamples<>(space_)};
    ray.samples.begin(pixel_ray(view_, pixels_->x(), pixels_->y()).direction);
    begun_.push_back(ray);
    pixels_->next();
  }

  void sample() {
    if (begun_.empty() || begun_.front().due > since_ || !cells_.empty()) return;
    Begun& ray = begun_.front();
    bool ends = false;
    for (std::uint32_t k = 0; k < hw_.samples && !ray.samples.done() && !ends; ++k) {
      glm::ivec3 cell;
      const bool inside = ray.samples.find_cell(cell);
      ray.samples.next();
      if (!inside || cell == ray.before) continue;
      ray.before = cell;
      const std::uint32_t from_eye = ray.samples.cells_from_eye(cell);
      ends = window_.behind(VisitWindow::place(0, from_eye));
      if (!ends) cells_.push_back({table_.numbers.of(cell), from_eye, rays_});
    }
    if (!ends && !ray.samples.done()) return;
    begun_.pop_front();
    ++rays_;
  }

  const SamplingHardware hw_;
  const View<float>& view_;
  const RenamingTable table_;
  const std::uint64_t base_;
  const SampleSpace space_;
  ClockedCache cache_;
  std::optional<RayPixels> pixels_;
  VisitWindow window_;
  std::uint64_t since_ = 0, last_work_ = 0;  // the pass began; the tables worked
  std::deque<Begun> begun_;
  std::deque<Cell> cells_;  // of one cycle's samples
  Cell looked_up_{};
  std::uint32_t record_ = 0;
  ClockedTransfer line_;
  std::optional<Found> found_;
  std::uint64_t rays_ = 0, ray_of_chain_ = ~std::uint64_t{0};
  std::uint32_t chain_ = 0;  // number of the voxel that the ray met last
  bool looks_up_ = false, misses_ = false, ended_ = false, overflows_ = false;
};

}  // namespace sgs::test

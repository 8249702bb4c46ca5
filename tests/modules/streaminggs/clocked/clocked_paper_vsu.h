// VSU of paper order register by register: the rays of a group, the ordering table with its slots
// that are cleared beside, lists of ordered voxels, and what hands them out: a piece on top of
// those that are open, which is cut or visited in a cycle, and a register of shares for the
// fetches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/voxel/voxel_grid.h"
#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_group_numbers.h"
#include "tests/modules/streaminggs/clocked/clocked_rays.h"
#include "tests/modules/streaminggs/clocked/clocked_sampling.h"

namespace sgs::test {

struct PaperVsuHardware {
  RaysHardware rays;
  std::uint32_t table_bytes = 4096, table_banks = 2;
  std::uint32_t cleared_slots = 4;  // a cycle
  std::uint32_t lists = 1;          // that wait
  std::uint32_t record_cache_bytes = 1024, cut_cache_bytes = 256;
  std::uint32_t visit_gaussians = 256, min_share = 16;
  GroupNumbersHardware numbers = {};
};

// What is handed out.
constexpr std::uint64_t kEndOfGroup = std::numeric_limits<std::uint64_t>::max();
inline std::uint64_t what_of(std::uint32_t first, std::uint32_t count) {
  return std::uint64_t{first} << 32U | count;
}

// Rays, Table: how rays are followed, and what takes their voxels.
template <class Rays, class Table>
class ClockedPaperVsu {
 public:
  // All but the rays and the table outlive it.
  ClockedPaperVsu(const PaperVsuHardware& hardware, const View<float>& view, const VoxelGrid& grid,
                  const VoxelTableLayout& layout, const std::vector<PixelRect>& groups,
                  const Rays& rays, const Table& table)
      : hw_(hardware),
        eye_(view.position),
        grid_(grid),
        layout_(layout),
        groups_(groups),
        rays_(rays),
        numbers_(hw_.numbers),
        port_(hw_.rays.port),
        table_(table),
        ordered_(hw_.lists),
        records_(hw_.record_cache_bytes),
        cuts_(hw_.cut_cache_bytes) {
    for (std::size_t group = 0; group < groups.size(); ++group) numbers_.ask();
  }

  // shares: one FIFO a fetch. finished: of a group, whether the news has come.
  template <class Finished>
  void step(std::vector<ClockedFifo<std::uint64_t>>& shares, const Finished& finished) {
    port_.begin_cycle();
    numbers_.step([&](std::uint32_t group) { return group <= followed_; });
    emit(shares, finished);
    traverse();
    ordered_.step();
  }

 private:
  struct List {
    std::uint32_t group;
    bool last;  // of its group
    std::vector<std::uint32_t> voxels;
  };
  struct Piece {
    VoxelRecord record;
    int axis;
  };
  enum class Pass { kBegin, kFollow, kGiveUp, kWithoutPlace, kOrder };
  enum class Emit { kIdle, kVoxel, kRecord, kPiece, kCut, kPlane, kVisit, kShares, kEnd };

  void traverse() {
    table_.begin_cycle();
    if (doing_ == Pass::kOrder && !table_.idle()) table_.step();
    if (busy_ > 0 && --busy_ > 0) return;
    if (doing_ == Pass::kOrder) {
      if (!table_.idle()) return;
      list_.voxels = table_.ordered();
      ordered_.put(std::move(list_));
      group_ += window_.last() ? 1 : 0;
      window_ = window_.last() ? VisitWindow() : window_.rest();
      doing_ = Pass::kBegin;
    }
    if (group_ == groups_.size()) return;
    if (doing_ == Pass::kBegin) {
      if (!numbers_.stand(static_cast<std::uint32_t>(group_))) return;
      followed_ = group_ + 1;
      table_.clear();
      rays_.begin(groups_[group_], window_);
      doing_ = Pass::kFollow;
    }
    if (doing_ == Pass::kFollow) {
      rays_.step(table_);
      if (!rays_.gives_up() && !rays_.done()) return;
      doing_ = rays_.gives_up() ? Pass::kGiveUp : Pass::kWithoutPlace;
    } else if (doing_ == Pass::kGiveUp) {
      rays_.wait_for_lines();
    }
    if (doing_ == Pass::kWithoutPlace) {
      if (ordered_.has_room()) order();  // where the list is written
    } else if (!rays_.waits_for_lines()) {
      window_ = rays_.window().nearer_half();
      busy_ = std::max(
          {clearing_cycles(), ReadyVoxels::all_words_for(most_voxels()), table_.free_tags()});
      doing_ = Pass::kBegin;
    }
  }
  std::uint64_t most_voxels() const { return OrderingTable::most_voxels(hw_.table_bytes); }
  std::uint64_t clearing_cycles() const {
    return Renaming::slots_for(most_voxels()) / hw_.cleared_slots;
  }
  void order() {
    doing_ = Pass::kOrder;
    table_.begin_order();
    list_ = {static_cast<std::uint32_t>(group_), window_.last(), {}};
    busy_ = clearing_cycles();
  }

  // Until something takes time.
  template <class Finished>
  void emit(std::vector<ClockedFifo<std::uint64_t>>& shares, const Finished& finished) {
    if (!port_.answered(line_) || (wait_ > 0 && --wait_ > 0)) return;
    while (wait_ == 0 && port_.answered(line_)) {
      switch (emitting_) {
        case Emit::kIdle:
          if (!ordered_.can_take()) return;
          next_ = 0;
          emitting_ = Emit::kVoxel;
          break;
        case Emit::kVoxel:
          if (next_ == list().voxels.size() || finished(list().group)) {
            const bool last = ordered_.take().last;
            go_on(last ? Emit::kEnd : Emit::kIdle, last ? 1 : 0);
          } else {
            look_up(records_, layout_.voxels, list().voxels[next_], Emit::kRecord);
          }
          break;
        case Emit::kRecord:
          open_ = {{grid_.voxels[list().voxels[next_++]], 0}};
          emitting_ = Emit::kPiece;
          break;
        case Emit::kPiece:
          next_piece();
          break;
        case Emit::kCut:
          look_up(cuts_, layout_.cuts, cut_index(cut_slot(open_.back().record)), Emit::kPlane);
          break;
        case Emit::kPlane:
          cut();
          break;
        case Emit::kVisit:
          fill_shares(shares.size());
          open_.pop_back();
          emitting_ = Emit::kShares;
          break;
        case Emit::kShares:
          if (!hand_out(shares)) return;
          emitting_ = finished(list().group) ? Emit::kVoxel : Emit::kPiece;
          break;
        case Emit::kEnd:
          if (sent_ == 0) share_of_.assign(shares.size(), kEndOfGroup), first_fetch_ = 0;
          if (!hand_out(shares)) return;
          emitting_ = Emit::kIdle;
          break;
      }
    }
  }
  const List& list() const { return ordered_.front(); }
  void go_on(Emit what, std::uint32_t cycles) {
    emitting_ = what;
    wait_ = cycles;
  }
  // What has come from memory is used in the cycle in which it is there.
  void look_up(ClockedCache& cache, const RecordArray& table, std::uint32_t index, Emit then) {
    const std::uint64_t line = table.address(index) / ClockedCache::kLineBytes;
    const bool hit = cache.hits(line);
    emitting_ = then;
    if (hit) return;
    cache.fill(line);
    line_ = {line * ClockedCache::kLineBytes, 1};
    port_.read(line_);
  }
  void next_piece() {
    if (open_.empty()) {
      emitting_ = Emit::kVoxel;
      return;
    }
    const std::uint32_t count = open_.back().record.count;
    const bool whole =
        hw_.visit_gaussians == 0 || count <= std::max(hw_.visit_gaussians, kLeastCut);
    go_on(whole ? Emit::kVisit : Emit::kCut, 1);
  }
  void cut() {
    const Piece piece = open_.back();
    open_.pop_back();
    const std::uint32_t slot = cut_slot(piece.record), left = slot - piece.record.first;
    const int next = (piece.axis + 1) % 3;
    const Piece low{{piece.record.first, left}, next};
    const Piece high{{slot, piece.record.count - left}, next};
    const bool low_first = eye_[piece.axis] < grid_.cuts[cut_index(slot)];
    open_.push_back(low_first ? high : low);
    open_.push_back(low_first ? low : high);
    emitting_ = Emit::kPiece;
  }

  // Even shares, of whole units.
  void fill_shares(std::size_t fetches) {
    const auto ceil_div = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
    const VoxelRecord& record = open_.back().record;
    const std::uint32_t unit = std::max(2U, hw_.min_share);
    const auto most =
        static_cast<std::uint32_t>(ceil_div(ceil_div(record.count, fetches), unit)) * unit;
    share_of_.clear();
    for (std::uint32_t at = 0, k = 0; k < fetches; ++k) {
      const std::uint32_t count = std::min(most, record.count - at);
      share_of_.push_back(what_of(record.first + at, count));
      at += count;
    }
    first_fetch_ = visit_;
  }
  // Into each FIFO in turn, as far as they have room.
  bool hand_out(std::vector<ClockedFifo<std::uint64_t>>& shares) {
    for (; sent_ < shares.size(); ++sent_) {
      ClockedFifo<std::uint64_t>& to = shares[(first_fetch_ + sent_) % shares.size()];
      if (!to.has_room()) return false;
      to.put(share_of_[sent_]);
    }
    sent_ = 0;
    ++visit_;
    return true;
  }

  const PaperVsuHardware hw_;
  const glm::vec3 eye_;
  const VoxelGrid& grid_;
  const VoxelTableLayout& layout_;
  const std::vector<PixelRect>& groups_;
  Rays rays_;
  ClockedGroupNumbers numbers_;
  std::size_t followed_ = 0;  // groups whose rays have begun
  ClockedPort port_;          // of records and planes
  ClockedTransfer line_;
  Table table_;
  Pass doing_ = Pass::kBegin;
  std::size_t group_ = 0;
  VisitWindow window_;  // of the pass
  std::uint64_t busy_ = 0;
  List list_;
  ClockedFifo<List> ordered_;
  Emit emitting_ = Emit::kIdle;
  std::uint32_t wait_ = 0;
  std::size_t next_ = 0;  // voxel of the list that is handed out, which keeps its place until then
  std::vector<Piece> open_;
  ClockedCache records_, cuts_;
  std::vector<std::uint64_t> share_of_;  // the register ahead of the FIFOs
  std::size_t first_fetch_ = 0, sent_ = 0, visit_ = 0;
};

}  // namespace sgs::test

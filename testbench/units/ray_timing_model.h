// The rays of VSU in paper order, cycle by cycle: what every ray does is known beforehand, and
// memory answers after a fixed time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "algorithm/memory/regions.h"
#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/lane_macs.h"
#include "algorithm/voxel/ray_event.h"
#include "algorithm/voxel/ray_work.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"

namespace sgs::tb {

using RayEvents = std::vector<RayEventOf>;  // of one ray, to its end

class RayTimingModel {
 public:
  RayTimingModel(const PaperVsuConfig& config, std::uint64_t latency, const RecordArray& nodes)
      : config_(config), latency_(latency), nodes_(nodes) {}

  struct Times {
    std::uint64_t all = 0, waits = 0;  // cycles; of these, those in which all wait for nodes
  };

  // Of all passes: look-ups for which there was no place before; those not found in the cache.
  std::uint64_t look_ups_again() const { return look_ups_again_; }
  std::uint64_t look_ups_missed() const { return look_ups_missed_; }

  // One pass without an overflow: rays in turn, into a table that is empty.
  Times pass(const std::vector<RayEvents>& rays, OrderingTable& table) {
    rays_ = &rays;
    table_ = &table;
    begun_ = 0;
    step_free_ = begin_free_ = tree_free_ = table_free_ = written_ = end_ = 0;
    places_.assign(config_.rays_in_flight, Place());
    for (std::size_t k = 0; k < places_.size(); ++k) begin(k, 0);
    Times times;
    for (std::uint64_t now = 0; busy(); ++now) {
      nodes_come(now);
      for (std::size_t k = 0; k < places_.size(); ++k) {
        if (places_[k].due == now) act(k, now);
        while (enter_next(now)) {
        }
      }
      turns(now);
      const bool none_due = look_ups_.empty() && steps_.empty() &&
                            std::all_of(places_.begin(), places_.end(),
                                        [](const Place& place) { return place.due == kNever; });
      if (none_due && !fetches_.empty() && now + 1 < fetches_.front().ready) ++times.waits;
    }
    times.all = end_;
    return times;
  }

 private:
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  struct Met {
    std::uint64_t round;
    std::uint32_t voxel;
  };
  struct Place {
    const RayEvents* ray = nullptr;  // none: free
    std::size_t next = 0;            // of its events
    std::uint64_t due = kNever;      // when it acts; never: it waits for somebody
    std::uint64_t round = 0;
    std::deque<Met> met;                 // and not entered
    std::deque<std::uint64_t> entering;  // when each is in the table
    OrderingTable::Chain chain;
    bool without_room = false, ended = false;
    bool called = false;  // a place is kept for its line
  };
  struct LookUp {
    std::size_t place;
    bool has_come;
  };
  struct Fetch {
    std::uint64_t line, ready;
    std::vector<std::size_t> places;
  };

  std::uint64_t interval(const OperationCounts& work, std::uint32_t lanes) const {
    return (folded_macs(work) + lanes - 1) / lanes;
  }
  static const RayEventOf& event(const Place& place) { return (*place.ray)[place.next]; }
  bool busy() const {
    return std::any_of(places_.begin(), places_.end(),
                       [](const Place& place) { return place.ray != nullptr; });
  }

  void begin(std::size_t k, std::uint64_t now) {
    Place& place = places_[k];
    place.ray = begun_ < rays_->size() ? &(*rays_)[begun_] : nullptr;
    if (place.ray == nullptr) return;
    ++begun_;
    place.next = 0;
    place.chain = {};
    place.ended = place.without_room = false;
    const std::uint64_t of_ray = interval(pixel_ray_work(), config_.ray_lanes);
    std::uint64_t start = std::max(now, begin_free_);
    while (start % of_ray != 0) ++start;
    begin_free_ = start + of_ray;
    place.due = start + config_.ray_depth_cycles;
  }

  void nodes_come(std::uint64_t now) {
    if (!fetches_.empty() && fetches_.front().ready == now) {
      auto& set = sets_[fetches_.front().line % set_count()];
      set.push_front(fetches_.front().line);
      if (set.size() > kCacheWays) set.pop_back();
      for (const std::size_t place : fetches_.front().places) look_ups_.push_back({place, true});
      fetches_.pop_front();
      call(now);
    }
  }

  // The first that found no place for its line.
  void call(std::uint64_t now) {
    if (without_place_.empty()) return;
    places_[without_place_.front()].due = now;
    places_[without_place_.front()].called = true;
    without_place_.pop_front();
    ++called_;
  }

  void act(std::size_t k, std::uint64_t now) {
    Place& place = places_[k];
    place.due = kNever;
    for (;; ++place.next) {
      switch (event(place).what) {
        case RayEvent::kLookUp:
          look_ups_.push_back({k, false});
          return;
        case RayEvent::kStep:
          ++place.round;
          steps_.push_back(k);
          return;
        case RayEvent::kVoxel:
          while (!place.entering.empty() && place.entering.front() <= now) {
            place.entering.pop_front();
          }
          if (place.met.size() + place.entering.size() == config_.chain_entries) {
            place.without_room = place.entering.empty();
            if (!place.without_room) place.due = place.entering.front();
            return;
          }
          place.met.push_back({place.round, event(place).index});
          break;
        case RayEvent::kEnd:
          place.ended = true;
          end_ = std::max(end_, now);
          return;
      }
    }
  }

  // The first of all places in the order of rounds: a voxel of it, or its next ray. False where
  // nothing of it is there yet.
  bool enter_next(std::uint64_t now) {
    const auto round_of = [](const Place& place) {
      if (!place.met.empty()) return place.met.front().round;
      return place.ray != nullptr ? place.round : kNever;
    };
    const auto first =
        std::min_element(places_.begin(), places_.end(),
                         [&](const Place& a, const Place& b) { return round_of(a) < round_of(b); });
    if (!first->met.empty()) {
      first->entering.push_back(enter(*first, now));
      first->met.pop_front();
      if (std::exchange(first->without_room, false)) first->due = first->entering.front();
      return true;
    }
    if (first->ray == nullptr || !first->ended) return false;
    ++first->round;
    if (begun_ < rays_->size()) tree_free_ = found(now);
    begin(static_cast<std::size_t>(first - places_.begin()), std::max(now, tree_free_));
    return true;
  }

  // The first of all rounds, of 8 in a cycle, of 64 in two, of 512 in three; not before what was
  // found last has gone.
  std::uint64_t found(std::uint64_t now) const {
    const std::uint64_t rays = config_.rays_in_flight;
    return std::max(tree_free_, now) + (rays <= 8 ? 1 : rays <= 64 ? 2 : rays <= 512 ? 3 : 4);
  }

  // A voxel once it is found and the table has taken the one before.
  std::uint64_t enter(Place& place, std::uint64_t now) {
    const std::uint64_t before = table_->accesses().cycles;
    table_->add(place.chain, place.met.front().voxel);
    tree_free_ = std::max(table_free_, found(now));
    table_free_ = std::max(tree_free_ + table_->accesses().cycles - before, written_);
    written_ = table_free_ + table_->write_cycles();
    end_ = std::max(end_, table_free_);
    return table_free_;
  }

  void turns(std::uint64_t now) {
    const std::uint64_t of_step = interval(ray_step_work(longest_step_case()), config_.step_lanes);
    if (!steps_.empty() && now >= step_free_ && now % of_step == 0) {
      Place& place = places_[steps_.front()];
      const bool of_a_cell = event(place).index == 0;
      place.due =
          now + (of_a_cell ? config_.cell_step_depth_cycles : config_.step_depth_cycles) + 1;
      ++place.next;
      steps_.pop_front();
      step_free_ = now + of_step;
    }
    if (look_ups_.empty()) return;
    const auto [k, has_come] = look_ups_.front();
    look_ups_.pop_front();
    Place& place = places_[k];
    const bool called = std::exchange(place.called, false);
    called_ -= called ? 1 : 0;
    look_ups_again_ += called ? 1 : 0;
    const std::uint64_t line = nodes_.address(event(place).index) / kLineBytes;
    const auto fetch = std::find_if(fetches_.begin(), fetches_.end(),
                                    [&](const Fetch& f) { return f.line == line; });
    const bool there = has_come || hits(line);
    look_ups_missed_ += there ? 0 : 1;
    if (there) {
      place.due = now + 3;  // tags, line, masks
      ++place.next;
    } else if (fetch != fetches_.end()) {
      fetch->places.push_back(k);
    } else if (fetches_.size() + called_ < config_.node_fetches) {
      fetches_.push_back({line, now + latency_ + 1, {k}});
      return;
    } else {
      without_place_.push_back(k);
      return;
    }
    if (called) call(now + 1);
  }

  bool hits(std::uint64_t line) {
    auto& set = sets_[line % set_count()];
    const auto at = std::find(set.begin(), set.end(), line);
    if (at == set.end()) return false;
    set.erase(at);
    set.push_front(line);
    return true;
  }
  std::uint64_t set_count() const {
    return std::max(1U, config_.node_cache_bytes / (kLineBytes * kCacheWays));
  }

  static constexpr std::uint32_t kLineBytes = 32, kCacheWays = 4;

  const PaperVsuConfig config_;
  const std::uint64_t latency_;
  const RecordArray nodes_;
  const std::vector<RayEvents>* rays_ = nullptr;
  OrderingTable* table_ = nullptr;
  std::vector<Place> places_;      // one in flight each
  std::size_t begun_ = 0;          // rays
  std::deque<std::size_t> steps_;  // places that wait for their turn
  std::deque<LookUp> look_ups_;    // likewise
  std::deque<Fetch> fetches_;
  std::deque<std::size_t> without_place_;
  std::size_t called_ = 0;
  std::uint64_t look_ups_again_ = 0, look_ups_missed_ = 0;   // of all passes
  std::map<std::uint64_t, std::deque<std::uint64_t>> sets_;  // lines, most recently used first
  std::uint64_t step_free_ = 0, begin_free_ = 0, tree_free_ = 0, table_free_ = 0, written_ = 0,
                end_ = 0;
};

}  // namespace sgs::tb

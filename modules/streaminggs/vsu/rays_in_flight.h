// The rays of a group side by side: each is a chain of steps and look-ups that wait for one
// another, so that lanes and cache are kept busy by many rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "modules/streaminggs/vsu/first_of.h"
#include "modules/streaminggs/vsu/node_fetches.h"
#include "modules/streaminggs/vsu/ray_unit.h"

namespace sgs {

// One pass over the rays of a group, as RaysInRounds makes it, with `rays_in_flight` contexts. Each
// ray steps when it can. A voxel that it meets waits in its context until no other ray can meet one
// before it: in an earlier round, or at an earlier place of the same round. So voxels enter the
// ordering table, and rays give their contexts to others, in the order of rounds. A ray without
// room for another voxel waits itself.
//
// Events are taken in the order of their cycles, those of one cycle in the order of the contexts.
// The kernel's time follows where it matters to another unit: when a node has to be fetched, when
// one is waited for, and at the end.
template <class Path>
class RaysInFlight {
 public:
  RaysInFlight(const View<float>& view, const Path& path, RayUnit& unit)
      : view_(view),
        unit_(unit),
        contexts_(unit.config.rays_in_flight, Context(path)),
        first_(unit.config.rays_in_flight) {}

  bool follow(const PixelRect& group, VisitWindow& window, OrderingTable& table, GroupVisits& out) {
    Pass pass{RayPixels(group, unit_.config.ray_step_px), window, table, out};
    pass_ = &pass;
    unit_.begin_pass();
    end_ = unit_.now();
    events_ = {};
    without_place_.clear();
    called_ = 0;
    for (std::uint32_t c = 0; c < contexts_.size(); ++c) {
      contexts_[c].round = 0;
      contexts_[c].met.clear();
      contexts_[c].leaves.clear();
      contexts_[c].called = false;
      begin_ray(c, unit_.now());
      compare(c);
    }
    while (!(events_.empty() && unit_.fetches.empty())) {
      // Rays go on until the table has said that a voxel does not fit.
      const std::uint64_t until = pass.fits ? kNever : end_;
      if (!wait_for_event(until)) continue;
      if (events_.empty() || events_.top().cycle >= until) break;
      const Event event = events_.top();
      events_.pop();
      go_on(event.context, event.cycle);
      compare(event.context);
      if (pass.fits) enter_in_turn(event.cycle);
    }
    unit_.advance_to(end_);
    if (!pass.fits) {
      unit_.take_what_comes();
      unit_.clear(table);
    }
    return pass.fits;
  }

  // Ordering writes the list: its place is free first.
  void ordered(const std::vector<std::uint32_t>& voxels, const OrderingTable& table, bool last) {
    unit_.lists.wait_for_room();
    unit_.order(table);
    unit_.lists.hand_over(voxels, last);
  }

 private:
  static constexpr std::uint64_t kNever = RayUnit::kNever;
  static constexpr std::uint32_t kNoNode = ~0U;

  enum class State : std::uint8_t { kFlies, kCalled, kWithoutRoom, kEnded, kFree };
  struct Met {
    std::uint64_t place, round;
  };
  struct Context {
    explicit Context(const Path& p) : path(p) {}
    Path path;
    State state = State::kFree;
    std::uint64_t round = 0;           // round that it is in
    std::deque<Met> met;               // voxels that wait to be entered
    std::deque<std::uint64_t> leaves;  // cycles at which those that are being entered leave
    OrderingTable::Chain chain;
    std::uint64_t without_room = kNever;  // place of the voxel for which there was none
    std::uint32_t wanted = kNoNode;       // node whose look-up has its turn
    bool called = false;                  // a place is kept for its line
  };
  struct Event {
    std::uint64_t cycle;
    std::uint32_t context;
    bool operator>(const Event& other) const {
      return std::tie(cycle, context) > std::tie(other.cycle, other.context);
    }
  };
  struct Pass {
    RayPixels pixels;
    VisitWindow& window;
    OrderingTable& table;
    GroupVisits& out;
    bool fits = true;
  };

  void at(std::uint64_t cycle, std::uint32_t c) { events_.push({cycle, c}); }

  // Begins a ray in a context that is free; none where all rays of the group have begun.
  void begin_ray(std::uint32_t c, std::uint64_t cycle) {
    Context& context = contexts_[c];
    context.state = pass_->pixels.done() ? State::kFree : State::kFlies;
    if (context.state == State::kFree) return;
    context.path.begin(pixel_ray(view_, pass_->pixels.x(), pass_->pixels.y()));
    context.chain = {};
    context.without_room = kNever;
    context.wanted = kNoNode;
    pass_->pixels.next();
    ++pass_->out.rays;
    ++pass_->out.steps;
    at(unit_.begin_ray(cycle), c);
  }

  // Waits until the next event is due, at most until this cycle, and no node that could come before
  // is on its way. False where nodes have come first, and may have made other events.
  bool wait_for_event(std::uint64_t until) {
    const std::uint64_t next = std::min(events_.empty() ? kNever : events_.top().cycle, until);
    if (unit_.fetches.empty()) return true;
    if (unit_.fetches.any_come()) {
      if (unit_.fetches.ready_cycle() > next) return true;
      take_nodes();
      return false;
    }
    if (next <= unit_.now()) return true;
    unit_.wait_for_nodes(next);
    return false;
  }

  void take_nodes() {
    const std::uint64_t cycle = unit_.fetches.ready_cycle();
    const NodeFetches::Fetch fetch = unit_.fetches.take();
    unit_.nodes.fill(fetch.line);
    for (const NodeFetches::Waiting& waiting : fetch.waiting) {
      contexts_[waiting.ray].path.give(unit_.nodes.record_in(fetch.line, waiting.node));
      at(unit_.look_up_again(cycle), waiting.ray);
    }
    call_next(cycle);
  }

  // A place for a line is free from this cycle on: the ray that waits for one longest looks up
  // again.
  void call_next(std::uint64_t cycle) {
    if (without_place_.empty()) return;
    const std::uint32_t c = without_place_.front();
    without_place_.pop_front();
    contexts_[c].state = State::kCalled;
    contexts_[c].called = true;
    ++called_;
    at(cycle, c);
  }

  // A ray does what it can in this cycle.
  void go_on(std::uint32_t c, std::uint64_t cycle) {
    Context& context = contexts_[c];
    if (context.state == State::kCalled) {
      context.state = State::kFlies;
      at(unit_.look_up_called(cycle), c);
      return;
    }
    if (context.wanted != kNoNode) {
      look_up(c, cycle);
      return;
    }
    if (context.without_room != kNever && !meet(c, context.without_room, cycle)) return;
    while (true) {
      const RayEventOf event = context.path.next();
      switch (event.what) {
        case RayEvent::kLookUp:
          context.wanted = event.index;
          at(unit_.look_up(cycle), c);
          return;
        case RayEvent::kStep:
          ++pass_->out.steps;
          ++context.round;
          at(unit_.step(cycle, event.index), c);
          return;
        case RayEvent::kVoxel: {
          const std::uint64_t place = VisitWindow::place(event.index, event.cells);
          unit_.met_voxel();
          if (pass_->window.behind(place)) {
            context.state = State::kEnded;
            return;
          }
          if (!pass_->window.before(place) && !meet(c, place, cycle)) return;
          break;
        }
        case RayEvent::kEnd:
          context.state = State::kEnded;
          return;
      }
    }
  }

  // A line that is missed takes a place until it has come. A ray that finds none free waits; one
  // that was called and does not need it leaves it to the next.
  void look_up(std::uint32_t c, std::uint64_t cycle) {
    Context& context = contexts_[c];
    const std::uint32_t node = std::exchange(context.wanted, kNoNode);
    const bool called = std::exchange(context.called, false);
    if (called) --called_;
    if (const auto* const line = unit_.nodes.find(node)) {
      context.path.give(unit_.nodes.record_in(*line, node));
      at(cycle + RayUnit::kLookUpCycles, c);
    } else if (auto* const others = unit_.fetches.waiting_for(unit_.nodes.line_of(node))) {
      unit_.joined();
      others->push_back({c, node});
    } else if (unit_.fetches.size() + called_ < unit_.config.node_fetches) {
      unit_.ask(unit_.nodes.line_of(node), cycle).push_back({c, node});
      return;
    } else {
      unit_.found_no_place();
      context.wanted = node;
      without_place_.push_back(c);
      return;
    }
    if (called) call_next(cycle + 1);
  }

  // True if there was room for the voxel; a ray that has none is called again when there is.
  bool meet(std::uint32_t c, std::uint64_t place, std::uint64_t cycle) {
    Context& context = contexts_[c];
    while (!context.leaves.empty() && context.leaves.front() <= cycle) context.leaves.pop_front();
    if (context.met.size() + context.leaves.size() < unit_.config.chain_entries) {
      context.without_room = kNever;
      context.met.push_back({place, context.round});
      return true;
    }
    context.without_room = place;
    if (context.leaves.empty()) {
      context.state = State::kWithoutRoom;
    } else {
      at(context.leaves.front(), c);
    }
    return false;
  }

  // Earliest round in which a context can enter something next.
  static std::uint64_t earliest(const Context& context) {
    if (!context.met.empty()) return context.met.front().round;
    return context.state == State::kFree ? kNever : context.round;
  }

  void compare(std::uint32_t c) { first_.set(c, earliest(contexts_[c])); }

  // Does what comes next in the order of rounds: enters a voxel into the table, or gives a ray's
  // context to another ray.
  void enter_in_turn(std::uint64_t cycle) {
    end_ = std::max(end_, cycle);
    while (pass_->fits) {
      const std::uint32_t first = first_.first();
      Context& context = contexts_[first];
      if (!context.met.empty()) {
        enter(context, cycle);
        if (context.state == State::kWithoutRoom) {
          context.state = State::kFlies;
          at(context.leaves.front(), first);
        }
      } else if (context.state == State::kEnded) {
        ++context.round;
        begin_ray(first, pass_->pixels.done() ? cycle : unit_.give_context(cycle));
      } else {
        return;
      }
      compare(first);
    }
  }

  void enter(Context& context, std::uint64_t cycle) {
    const std::uint64_t place = context.met.front().place;
    context.met.pop_front();
    pass_->window.meet(place);
    pass_->fits = pass_->table.add(context.chain, VisitWindow::voxel(place));
    context.leaves.push_back(unit_.enter(pass_->table, cycle));
    end_ = std::max(end_, context.leaves.back());
  }

  const View<float>& view_;
  RayUnit& unit_;
  std::vector<Context> contexts_;
  FirstOf first_;  // the context whose next entry has the earliest round
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::deque<std::uint32_t> without_place_;  // contexts, for a line that they miss
  std::uint32_t called_ = 0;  // contexts called for a place that have not looked up yet
  Pass* pass_ = nullptr;
  std::uint64_t end_ = 0;  // end of the pass, as far as it is known
};

}  // namespace sgs

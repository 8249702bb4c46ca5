// The rays of a group in VSU of paper order register by register: contexts that wait in queues for
// lanes and nodes; what is in their pipelines; and the tree that compares rounds, whose answer
// waits for the ordering table. How a ray goes through the voxel tree is its own
// (algorithm/voxel/ray_path.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "algorithm/voxel/ray_path.h"
#include "tests/modules/streaminggs/clocked/clocked_cache.h"
#include "tests/modules/streaminggs/clocked/clocked_ordering_table.h"

namespace sgs::test {

struct RaysHardware {
  std::uint32_t rays = 80, chain_entries = 3, ray_step_px = 2;
  std::uint32_t step_turn = 1, begin_turn = 8;  // cycles from one to the next on the lanes
  std::uint32_t block_cycles = 46, cell_cycles = 13, begin_cycles = 100;
  std::uint32_t compare_cycles = 3;  // of the rounds of all
  std::uint32_t node_cache_bytes = 2048;
  PortHardware port = {};
  std::uint32_t node_fetches = 7;  // lines on their way
};

class ClockedRays {
 public:
  ClockedRays(const RaysHardware& hw, const View<float>& view, const VoxelGrid& grid,
              const RecordArray& nodes)
      : hw_(hw),
        view_(view),
        grid_(grid),
        table_of_nodes_(nodes),
        contexts_(hw.rays, Context{RayPath<float>(grid.frame)}),
        nodes_(hw.node_cache_bytes, hw.port, hw.node_fetches) {}

  // All is free and the table empty; the first step is of this cycle. window: of what is entered.
  void begin(const PixelRect& group, const VisitWindow& window) {
    pixels_.emplace(group, hw_.ray_step_px);
    window_ = window;
    since_ = 0;
    overflows_ = false;
    for (std::size_t c = 0; c < contexts_.size(); ++c) {
      contexts_[c].round = 0;
      give_ray(c);
    }
  }
  bool done() const {
    if (!nodes_.idle() || adding_) return false;
    for (const Context& context : contexts_) {
      if (context.state != State::kFree || context.waiting() > 0) return false;
    }
    return true;
  }

  // Of what was entered.
  const VisitWindow& window() const { return window_; }
  // The table had no room: all is given up, but for lines on their way.
  bool gives_up() const { return overflows_; }
  bool waits_for_lines() const { return !nodes_.idle(); }
  void wait_for_lines() { nodes_.lines_come(); }

  void step(ClockedOrderingTable& table) {
    nodes_.lines_come();
    call();
    leave_table(table);
    if (overflows_) return give_up();
    decide(table);
    for (std::size_t c = 0; c < contexts_.size(); ++c) act(c);
    if (pixels_->done()) free_ended();
    if (compare_left_ == 0 && !found_) compare();
    begin_turns();
    ++since_;
  }

 private:
  enum class State : std::uint8_t { kFree, kWaits, kDue, kCalled, kWithoutRoom, kEnded };
  struct Met {
    std::uint64_t round, place;
  };
  struct Context {
    explicit Context(const RayPath<float>& p) : path(p) {}
    RayPath<float> path;
    State state = State::kFree;
    std::uint32_t left = 0;  // cycles until it is due
    std::uint64_t round = 0;
    RayEventOf event;  // that it waits with
    std::deque<Met> met;
    std::uint32_t entering = 0;  // entries of the chain that the table has not taken yet
    ClockedOrderingTable::Chain chain = ClockedOrderingTable::kNone;
    std::size_t waiting() const { return met.size() + entering; }
  };
  static constexpr std::uint32_t kLookUpCycles = 3;  // tags, line, masks
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  void give_ray(std::size_t c) {
    Context& context = contexts_[c];
    context.state = State::kFree;
    if (pixels_->done()) return;
    context.path.begin(pixel_ray(view_, pixels_->x(), pixels_->y()));
    context.chain = ClockedOrderingTable::kNone;
    of_ray_before_ = of_ray_before_ || (adding_ && entering_ == c);
    pixels_->next();
    context.state = State::kWaits;
    begins_.push_back(c);
  }

  void due_in(std::size_t c, std::uint32_t cycles) {
    contexts_[c].state = State::kDue;
    contexts_[c].left = cycles;
  }

  void leave_table(ClockedOrderingTable& table) {
    table.step();
    if (!adding_ || !table.idle()) return;
    adding_ = false;
    overflows_ = !table.fits();
    --contexts_[entering_].entering;
    if (!of_ray_before_) contexts_[entering_].chain = table.number();
    if (contexts_[entering_].state == State::kWithoutRoom) due_in(entering_, 1);
  }

  // What the tree has found: a voxel that the table takes as soon as it is free, or a ray that has
  // ended, whose context the next one gets.
  void decide(ClockedOrderingTable& table) {
    if (compare_left_ > 0 && --compare_left_ > 0) return;
    if (!found_) return;
    Context& context = contexts_[*found_];
    if (context.met.empty()) {
      ++context.round;
      give_ray(*found_);
    } else {
      if (adding_) return;
      window_.meet(context.met.front().place);
      table.begin_add(context.chain, VisitWindow::voxel(context.met.front().place));
      context.met.pop_front();
      ++context.entering;
      entering_ = *found_;
      adding_ = true;
      of_ray_before_ = false;
    }
    found_.reset();
  }

  // The tree begins where its answer will be one: the first of all rounds does not wait for a ray.
  void compare() {
    std::size_t first = 0;
    for (std::size_t c = 1; c < contexts_.size(); ++c) {
      if (earliest(contexts_[c]) < earliest(contexts_[first])) first = c;
    }
    const Context& context = contexts_[first];
    if (context.met.empty() && context.state != State::kEnded) return;
    found_ = first;
    compare_left_ = hw_.compare_cycles;
  }
  static std::uint64_t earliest(const Context& context) {
    if (!context.met.empty()) return context.met.front().round;
    return context.state == State::kFree ? kNever : context.round;
  }
  // No other ray comes.
  void free_ended() {
    for (Context& context : contexts_) {
      if (context.state == State::kEnded && context.met.empty()) context.state = State::kFree;
    }
  }

  void give_up() {
    for (Context& context : contexts_) context = Context(RayPath<float>(grid_.frame));
    begins_.clear();
    steps_.clear();
    nodes_.forget_who_waits();
    found_.reset();
    compare_left_ = 0;
  }

  // For a line's place that is free.
  void call() {
    if (const std::optional<std::size_t> c = nodes_.call()) contexts_[*c].state = State::kCalled;
  }
  std::uint64_t wanted_line(const Context& context) const {
    return table_of_nodes_.address(context.event.index) / ClockedCache::kLineBytes;
  }

  // A ray that is due goes on until it wants lanes, a node or room.
  void act(std::size_t c) {
    Context& context = contexts_[c];
    if (context.state == State::kCalled) {
      context.state = State::kWaits;
      nodes_.ask(c, wanted_line(context), true);
      return;
    }
    if (context.state != State::kDue || --context.left > 0) return;
    while (true) {
      if (context.event.what != RayEvent::kVoxel) context.event = context.path.next();
      switch (context.event.what) {
        case RayEvent::kLookUp:
          context.state = State::kWaits;
          nodes_.ask(c, wanted_line(context));
          return;
        case RayEvent::kStep:
          context.state = State::kWaits;
          ++context.round;
          steps_.push_back(c);
          return;
        case RayEvent::kVoxel: {
          const auto place = VisitWindow::place(context.event.index, context.event.cells);
          if (window_.behind(place)) {
            context.state = State::kEnded;
            context.event = {};
            return;
          }
          if (!window_.before(place)) {
            if (context.waiting() == hw_.chain_entries) {
              context.state = State::kWithoutRoom;
              return;
            }
            context.met.push_back({context.round, place});
          }
          context.event = {};
          break;
        }
        case RayEvent::kEnd:
          context.state = State::kEnded;
          return;
      }
    }
  }

  void begin_turns() {
    if (!begins_.empty() && since_ % hw_.begin_turn == 0) {
      due_in(begins_.front(), hw_.begin_cycles);
      begins_.pop_front();
    }
    if (!steps_.empty() && since_ % hw_.step_turn == 0) {
      const bool of_a_cell = contexts_[steps_.front()].event.index == 0;
      due_in(steps_.front(), (of_a_cell ? hw_.cell_cycles : hw_.block_cycles) + 1);
      steps_.pop_front();
    }
    if (const std::optional<std::size_t> c = nodes_.look_up()) {
      contexts_[*c].path.give(grid_.nodes[contexts_[*c].event.index]);
      due_in(*c, kLookUpCycles);
    }
    call();
  }

  const RaysHardware hw_;
  const View<float>& view_;
  const VoxelGrid& grid_;
  const RecordArray table_of_nodes_;
  std::optional<RayPixels> pixels_;
  VisitWindow window_;
  bool overflows_ = false;
  std::uint64_t since_ = 0;  // the pass began
  std::vector<Context> contexts_;
  std::deque<std::size_t> begins_, steps_;
  ClockedSharedCache nodes_;
  std::uint32_t compare_left_ = 0;    // cycles of the tree
  std::optional<std::size_t> found_;  // first of all rounds, when it has ended
  std::size_t entering_ = 0;          // context whose voxel the table takes
  bool adding_ = false;               // still
  bool of_ray_before_ = false;        // whose context has the next ray already
};

}  // namespace sgs::test

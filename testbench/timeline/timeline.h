// A trace for Perfetto: the states of every activity of a machine, and how full its queues were.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "modules/machine.h"
#include "testbench/timeline/activity_track.h"
#include "testbench/timeline/instant_watcher.h"
#include "testbench/timeline/track_events.h"

namespace sgs {

// Bytes on the memory's data buses over time.

// Listens to the commands as long as it lives; a burst counts where its command stands.
class BusMeter : public CommandSink {
 public:
  // step_ns: of time that is added up.
  BusMeter(DramController& memory, double step_ns);
  ~BusMeter() override { memory_.remove_command_sink(*this); }
  BusMeter(const BusMeter&) = delete;
  BusMeter& operator=(const BusMeter&) = delete;

  void on_command(const CommandRecord& record) override;

  // 10^9 B/s in each step up to now.
  std::vector<double> gb_per_s();

 private:
  DramController& memory_;
  const double step_ns_, steps_per_cycle_;
  const std::uint64_t burst_bytes_;
  std::vector<std::uint64_t> bytes_;
};

// A track for each activity, under its unit; counters of queues, memory ports, what units publish
// as levels, and of the memory's bus. Times are cycles of the machine. It looks at what the
// machine counts anyway, when an instant is over: without one nothing costs anything.
class Timeline {
 public:
  // To be made before the simulation begins. groups: only what belongs to them, and of the rest
  // what happens while one of them is worked on.
  Timeline(OutputFile& to, Machine& machine, DramController& memory, const GroupRange& groups);

  // After the simulation, and after every activity was closed. Throws std::runtime_error when the
  // trace could not be written whole.
  void close();

 private:
  // Whatever has a number at any time.
  struct Level {
    TrackEvents::Track track;
    std::function<std::uint64_t()> value;
    std::optional<std::uint64_t> last;
  };
  class Sheet;

  void look();
  void sample(std::uint64_t now);

  OutputFile& to_;
  Machine& machine_;
  TrackEvents events_;
  const GroupRange groups_;
  std::vector<ActivityTrack> activities_;
  std::vector<Level> levels_;
  BusMeter bus_;
  TrackEvents::Track bus_track_ = 0;
  std::uint64_t next_sample_ = 0;
  struct Window {
    std::uint64_t from, to;
  };
  std::vector<Window> windows_;  // in which one of the groups is worked on
  bool in_window_ = false;       // the last is open
  std::optional<InstantWatcher> watcher_;
};

}  // namespace sgs

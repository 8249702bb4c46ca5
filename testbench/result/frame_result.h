// Results of one simulated frame, as values: they outlive the simulation and cross the boundary
// between processes once. Reports are made from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tlm/data_sheet.h"

namespace sgs {

// Cycles that an activity waited for one thing at one place. Names are paths below the machine.
struct WaitResult {
  WaitFor what = WaitFor::kIdle;
  std::string at;     // FIFO, port or unit; empty with kIdle
  std::string other;  // path of the activity at the other end of the FIFO; empty elsewhere
  Remedy remedy;      // to wait less
  std::uint64_t cycles = 0;
};

struct ActivityResult {
  std::string name, resource, meaning;
  std::uint64_t busy_cycles = 0;
  std::vector<WaitResult> waits;  // with the busy cycles they add up to the frame
  Remedy remedy;                  // to work faster

  std::uint64_t waited_for(WaitFor what) const;
};

struct CounterResult {
  std::string name, unit, meaning;
  std::uint64_t value = 0;
};

struct UnitResult {
  std::string name;  // path below the machine
  std::vector<ActivityResult> activities;
  std::vector<CounterResult> counters;
  std::vector<Remedy> may_help = {};  // beside those of activities and waits
  bool charged = false;  // it did something that is paid for: operations, items or accesses
};

// Operations of one kind that one component did, and the parts that did them.
struct Operations {
  std::string component, kind;
  double count = 0;
};
struct Parts {
  std::string component, kind;
  double count = 0;
  double per_cycle = 0;  // operations that all of them can do a cycle
};

// Parts and on-chip memory of all units of one kind: hfu0.coarse and hfu3.fine are of "hfu".
struct OwnerResult {
  std::string owner;
  std::vector<Parts> parts;
  SramUses sram_uses;
};
// The owner of what the machine states for itself: the queues between its units.
constexpr const char* kBetweenUnits = "between_units";

// A datapath with all its copies in all units, and what they did.
struct DatapathResult {
  Datapath datapath;
  std::uint64_t items = 0;
  std::uint64_t busiest_cycles = 0;  // least cycles of the unit with the most items to its lanes
};

// Accesses of one use, of all units that have it.
struct SramAccesses {
  std::string use;
  std::uint64_t reads = 0, writes = 0;
  SramPeak seen{0, 0};  // most of one cycle, where it was looked at
};

struct LeftOut {
  std::string what, why;
  std::uint64_t count = 0;
  std::string saves;
};

// Values by part of the machine, as DataSheet::by_part(); those of several units are added up.
struct PartValues {
  std::string name, unit, meaning;
  std::vector<std::uint64_t> values;  // [part]
};
constexpr const char* kBytesOfParts = "bytes";  // requested by ports

// The contents of a machine's data sheets, in the order in which they are published.
struct MachineResult {
  std::vector<UnitResult> units;
  std::vector<Operations> operations;  // those of lanes included
  std::vector<Parts> parts;            // lanes included
  std::vector<LeftOut> left_out;       // one entry a saving: counts of several units added up
  SramUses sram_uses;                  // the same use of several units added up
  std::vector<OwnerResult> owners;     // these parts and uses, by who has them
  std::vector<std::pair<std::string, std::uint64_t>> sram_available;  // (memory, bytes)
  std::vector<SramAccesses> sram_accesses;
  std::vector<DatapathResult> datapaths;
  std::vector<PartValues> by_part;
};

// Bytes that one requester asked for in one region.
struct RegionTraffic {
  std::string region, requester;
  std::uint64_t read_bytes = 0, written_bytes = 0;
};

// A state of the memory's ranks: the mean time that they spend in it, and what it draws.
struct MemoryState {
  std::string name;
  double time_s = 0, energy_j = 0;
};
constexpr const char* kSelfRefreshState = "self_refresh";

struct MemoryResult {
  std::uint64_t bytes = 0, bus_bytes = 0;  // asked for; moved, in whole bursts
  std::vector<RegionTraffic> traffic;      // regions with traffic
  std::vector<std::pair<std::string, std::uint64_t>> bus_bytes_by_region;  // all regions
  std::uint64_t transactions = 0;
  std::uint64_t row_hits = 0, row_misses = 0, row_conflicts = 0, refreshes = 0;
  double bandwidth_gb_s = 0, busy_bandwidth_gb_s = 0, peak_gb_s = 0;
  double read_latency_mean_ns = 0, read_latency_p50_ns = 0, read_latency_p99_ns = 0;
  std::uint32_t channels = 0, write_queue_entries = 0;
  double bus_utilisation = 0;  // data bus of the busiest channel, 0 to 1
  Remedy remedy;               // for more of it
  double energy_j = 0, energy_least_j = 0, energy_most_j = 0;
  std::string energy_not_stated;  // what its memspec lacks for that; empty: it is known
  std::vector<std::pair<std::string, double>> energy_by_current_set_j, energy_by_region_j;
  // Add up to the energy.
  std::vector<MemoryState> states;
  std::vector<std::pair<std::string, double>> commands;  // above their states

  double time_in_s(const std::string& state) const;
};

// A frame of a stream. Seconds since the start, but for the wait.
struct StreamedFrame {
  double pose_s = 0;         // its pose was there
  double begun_s = 0;        // the machine read the pose
  double drawn_s = 0;        // its last pixel was in the memory
  double shown_s = 0;        // its first row was read for the display
  double buffer_wait_s = 0;  // so long its pixels waited for a buffer that the display showed
};
struct FrameResult;
struct StreamResult {
  std::vector<StreamedFrame> frames;
  std::uint64_t pictures = 0;   // shown, from the first frame's to the last one's
  std::uint64_t repeated = 0;   // of these, for want of the next frame
  std::uint64_t rows_late = 0;  // not there when the display was to show them
  // Counts up to the moment when the first frame and the last one are shown: between them the
  // stream flows. None without a display.
  std::vector<FrameResult> first_and_last_shown;
};

struct FrameResult {
  std::uint64_t cycles = 0;
  std::uint64_t rest_cycles = 0;  // of these, in which no frame was under way: the clock stands
  double clock_mhz = 0;
  bool drained = false;  // FIFOs empty, nothing in flight
  MachineResult machine;
  MemoryResult memory;
  std::vector<std::byte> frame;        // the frame buffer as read back from the memory
  std::vector<std::byte> right_frame;  // the right eye's, where there are two
  StreamResult stream;                 // of frames back to back: then all else is of all of them
  double wall_s = 0;                   // elaboration, loading of the memory, simulation

  double time_s() const { return static_cast<double>(cycles) / (clock_mhz * 1e6); }
};

std::string to_wire(const FrameResult& result);
// Reads the bytes that to_wire() made in the same build.
FrameResult from_wire(const std::string& bytes);

}  // namespace sgs

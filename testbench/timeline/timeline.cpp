#include "testbench/timeline/timeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/result/collect.h"

namespace sgs {

namespace {

// Levels change every few cycles: one is written at most once in so many.
constexpr std::uint64_t kLevelCycles = 64;
constexpr std::uint64_t kBusCycles = 256;  // cycles over which the bus's rate is averaged

}  // namespace

BusMeter::BusMeter(DramController& memory, double step_ns)
    : memory_(memory),
      step_ns_(step_ns),
      steps_per_cycle_(memory.memspec().clock_period_ns / step_ns),
      burst_bytes_(memory.memspec().burst_bytes()) {
  memory.add_command_sink(*this);
}

void BusMeter::on_command(const CommandRecord& record) {
  if (!is_read(record.command) && !is_write(record.command)) return;
  const auto step = static_cast<std::size_t>(static_cast<double>(record.cycle) * steps_per_cycle_);
  if (step >= bytes_.size()) bytes_.resize(step + 1);
  bytes_[step] += burst_bytes_;
}

std::vector<double> BusMeter::gb_per_s() {
  memory_.catch_up();
  std::vector<double> rates;
  for (const std::uint64_t bytes : bytes_) rates.push_back(static_cast<double>(bytes) / step_ns_);
  return rates;
}

// In the order in which the machine publishes them.
class Timeline::Sheet : public DataSheet {
 public:
  struct Unit {
    std::string name;
    std::vector<const Activity*> activities;
  };
  struct Gauge {
    std::string name, unit;
    const std::uint32_t* value;
  };

  explicit Sheet(const Machine& machine) : machine_(machine) {}
  void unit(const sc_core::sc_object& unit) override {
    units.push_back({path_below(unit, machine_), {}});
  }
  void activity(Activity& activity, const char*, const char*) override {
    units.back().activities.push_back(&activity);
  }
  void queue(FifoChannel& queue, const char*) override { queues.push_back(&queue); }
  void port(MemoryPort& port, const char*) override { ports.push_back(&port); }
  void level(const char* name, const char* unit, const std::uint32_t& value) override {
    gauges.push_back({units.back().name + "." + name, unit, &value});
  }

  std::vector<Unit> units;
  std::vector<const FifoChannel*> queues;
  std::vector<const MemoryPort*> ports;
  std::vector<Gauge> gauges;

 private:
  const Machine& machine_;
};

Timeline::Timeline(OutputFile& to, Machine& machine, DramController& memory,
                   const GroupRange& groups)
    : to_(to),
      machine_(machine),
      events_(to),
      groups_(groups),
      bus_(memory, kBusCycles * machine.clock().period() / sc_core::sc_time(1, sc_core::SC_NS)) {
  watcher_.emplace([this] { look(); });
  Sheet sheet(machine);
  machine.publish(sheet);
  const TrackEvents::Track root =
      events_.process(fmt::format("accelerator, 1 ns is a cycle of {} MHz", machine.clock().mhz()));
  const PlaceName place = [&machine](const sc_core::sc_object& at) {
    return path_below(at, machine);
  };
  for (const Sheet::Unit& unit : sheet.units) {
    if (unit.activities.empty()) continue;
    const TrackEvents::Track parent = events_.track(root, unit.name);
    for (const Activity* activity : unit.activities) {
      const std::string name = unit.name + "." + activity->basename();
      activities_.emplace_back(*activity, events_, events_.track(parent, name), groups, place);
    }
  }
  const auto add = [&](TrackEvents::Track parent, const std::string& name, const char* unit,
                       std::function<std::uint64_t()> value) {
    levels_.push_back({events_.counter(parent, name, unit), std::move(value), {}});
  };
  for (const Sheet::Gauge& gauge : sheet.gauges) {
    add(root, gauge.name, gauge.unit.c_str(), [value = gauge.value] { return *value; });
  }
  const TrackEvents::Track bus = events_.track(root, "memory");
  bus_track_ = events_.counter(bus, "data buses", "GB/s");
  const TrackEvents::Track queues = events_.track(root, "FIFOs");
  for (const FifoChannel* queue : sheet.queues) {
    add(queues, fmt::format("{} (of {})", place(*queue), queue->capacity()), "entries",
        [queue] { return queue->fill(); });
  }
  const TrackEvents::Track ports = events_.track(root, "memory ports");
  for (const MemoryPort* port : sheet.ports) {
    add(ports, place(*port), "B outstanding", [port] { return port->bytes_outstanding(); });
  }
}

void Timeline::look() {
  const std::uint64_t now = machine_.clock().now_cycles();
  std::optional<std::uint64_t> window_from;
  if (in_window_) window_from = windows_.back().from;
  bool in_window = groups_.all();
  for (ActivityTrack& track : activities_) {
    track.look(now, window_from);
    in_window = in_window || track.in_range();
  }
  if (in_window && !in_window_) windows_.push_back({now, now});
  if (in_window_) windows_.back().to = now;
  in_window_ = in_window;
  if (now >= next_sample_) sample(now);
}

void Timeline::sample(std::uint64_t now) {
  next_sample_ = now - now % kLevelCycles + kLevelCycles;
  if (!in_window_) return;
  for (Level& level : levels_) {
    const std::uint64_t value = level.value();
    if (level.last == value) continue;
    level.last = value;
    events_.value(level.track, now, value);
  }
}

void Timeline::close() {
  watcher_.reset();
  look();
  sample(machine_.clock().now_cycles());
  for (ActivityTrack& track : activities_) track.finish();
  const std::vector<double> rates = bus_.gb_per_s();
  std::optional<double> last;
  for (std::size_t step = 0; step < rates.size(); ++step) {
    const std::uint64_t from = step * kBusCycles, to = from + kBusCycles;
    const bool shown = std::any_of(windows_.begin(), windows_.end(), [&](const Window& window) {
      return from < window.to && window.from < to;
    });
    if (!shown || last == rates[step]) continue;
    last = rates[step];
    events_.value(bus_track_, from, rates[step]);
  }
  to_.finish();
}

}  // namespace sgs

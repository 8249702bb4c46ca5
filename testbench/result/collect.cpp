// Visitors of the data sheets.
#include "testbench/result/collect.h"

#include <algorithm>
#include <cstring>

namespace sgs {
namespace {

class Collector : public LeftOutCollector {
 public:
  Collector(const Machine& machine, MachineResult& into)
      : LeftOutCollector(into.left_out), machine_(machine), into_(into) {}

  void unit(const sc_core::sc_object& unit) override {
    into_.units.push_back({path_below(unit, machine_), {}, {}});
  }
  void activity(Activity& activity, const char* resource, const char* meaning) override {
    activity.close();
    into_.units.back().activities.push_back({activity.basename(), resource, meaning,
                                             activity.busy_cycles(), activity.starved_cycles(),
                                             activity.blocked_cycles()});
  }
  void counter(const char* name, const char* unit, const char* meaning,
               std::uint64_t value) override {
    into_.units.back().counters.push_back({name, unit, meaning, value});
  }
  void operations(const char* component, const char* kind, double count) override {
    add(into_.operations, component, kind, count);
  }
  void part(const char* component, const char* kind, double count) override {
    add(into_.parts, component, kind, count);
  }
  void sram(const SramUse& use) override { sgs::add(into_.sram_uses, use); }
  void sram_available(const char* memory, std::uint64_t bytes) override {
    constexpr double kKiB = 1024;
    into_.sram_available.emplace_back(memory, bytes);
    add(into_.parts, "sram", "sram_kib", static_cast<double>(bytes) / kKiB);
  }
  void datapath(const Datapath& datapath) override { into_.datapaths.push_back(datapath); }

 private:
  static void add(std::vector<Amount>& amounts, const char* component, const char* kind,
                  double count) {
    const auto same = std::find_if(amounts.begin(), amounts.end(), [&](const Amount& a) {
      return a.component == component && a.kind == kind;
    });
    if (same != amounts.end()) {
      same->count += count;
    } else {
      amounts.push_back({component, kind, count});
    }
  }

  const Machine& machine_;
  MachineResult& into_;
};

class Drained : public DataSheet {
 public:
  void queue(FifoChannel& queue, const char*) override { all = all && queue.fill() == 0; }
  void port(MemoryPort& port) override { all = all && port.idle(); }
  bool all = true;
};

}  // namespace

void LeftOutCollector::left_out(const char* what, const char* why, std::uint64_t count,
                                const std::string& saves) {
  if (count == 0) return;
  const auto same = std::find_if(into_.begin(), into_.end(),
                                 [&](const LeftOut& entry) { return entry.what == what; });
  if (same != into_.end()) {
    same->count += count;
  } else {
    into_.push_back({what, why, count, saves});
  }
}

MachineResult collect(Machine& machine) {
  MachineResult result;
  Collector collector(machine, result);
  machine.publish(collector);
  std::uint64_t idle = 0;
  for (const UnitResult& unit : result.units) {
    for (const ActivityResult& activity : unit.activities) idle += activity.busy_cycles == 0;
  }
  collector.left_out("idle_activities", "never fed in this frame", idle,
                     "their area, if every frame is like this one");
  const auto is_empty = [](const UnitResult& unit) {
    return unit.activities.empty() && unit.counters.empty();
  };
  result.units.erase(std::remove_if(result.units.begin(), result.units.end(), is_empty),
                     result.units.end());
  return result;
}

bool drained(Machine& machine) {
  Drained sheet;
  machine.publish(sheet);
  return sheet.all;
}

std::string path_below(const sc_core::sc_object& object, const Machine& machine) {
  const std::size_t skip = std::strlen(machine.name());
  const std::string name = object.name();
  return name.size() > skip ? name.substr(skip + 1) : name;
}

}  // namespace sgs

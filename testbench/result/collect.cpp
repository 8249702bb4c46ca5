// Visitors of the data sheets.
#include "testbench/result/collect.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace sgs {
namespace {

// "hfu3.coarse" -> "hfu": the kind of unit that a path below the machine belongs to.
std::string owner_of(const std::string& path) {
  const std::string unit = path.substr(0, path.find('.'));
  return unit.substr(0, unit.find_last_not_of("0123456789") + 1);
}

class Collector : public LeftOutCollector {
 public:
  Collector(const Machine& machine, MachineResult& into)
      : LeftOutCollector(into.left_out), machine_(machine), into_(into) {}

  void unit(const sc_core::sc_object& unit) override {
    into_.units.push_back({path_below(unit, machine_), {}, {}});
    table_ = kOutstandingTable;
    const std::string owner =
        &unit == &machine_ ? kBetweenUnits : owner_of(into_.units.back().name);
    const auto same = std::find_if(into_.owners.begin(), into_.owners.end(),
                                   [&](const OwnerResult& o) { return o.owner == owner; });
    owner_ = static_cast<std::size_t>(same - into_.owners.begin());
    if (same == into_.owners.end()) into_.owners.push_back({owner, {}, {}});
  }
  void activity(Activity& activity, const char* resource, const char* meaning) override {
    activity.close();
    ActivityResult result{activity.basename(), resource, meaning, activity.busy_cycles(), {}, {}};
    for (const Activity::Wait& wait : activity.waits()) {
      if (wait.cycles > 0) result.waits.push_back(wait_of(wait, activity));
    }
    // Which was waited for first may depend on the order of processes, if only for no time at all.
    std::sort(result.waits.begin(), result.waits.end(), [](const auto& a, const auto& b) {
      return std::tie(a.what, a.at) < std::tie(b.what, b.at);
    });
    into_.units.back().activities.push_back(std::move(result));
  }
  void remedy(const Activity& activity, const Remedy& remedy) override {
    for_work_[path_below(activity, machine_)] = remedy;
  }
  void may_help(const Remedy& remedy) override { into_.units.back().may_help.push_back(remedy); }
  void remedy(const sc_core::sc_object& at, WaitFor what, const Remedy& remedy) override {
    for_waits_[{path_below(at, machine_), what}] = remedy;
  }
  void counter(const char* name, const char* unit, const char* meaning,
               std::uint64_t value) override {
    into_.units.back().counters.push_back({name, unit, meaning, value});
  }
  void by_part(const char* name, const char* unit, const char* meaning,
               const std::vector<std::uint64_t>& values) override {
    if (values.empty()) return;
    auto same = std::find_if(into_.by_part.begin(), into_.by_part.end(),
                             [&](const PartValues& p) { return p.name == name; });
    if (same == into_.by_part.end()) same = into_.by_part.insert(same, {name, unit, meaning, {}});
    if (same->values.size() < values.size()) same->values.resize(values.size());
    for (std::size_t part = 0; part < values.size(); ++part) same->values[part] += values[part];
  }
  void datapath(const Datapath& path, std::uint64_t items) override {
    const double own_lanes = path.lanes_of.empty() ? static_cast<double>(path.all_lanes()) : 0;
    part(path.component.c_str(), path.lane.c_str(), own_lanes, 1);
    operations(path.component.c_str(), path.lane.c_str(),
               static_cast<double>(items) * path.used_macs);
    for (const BesideLanes& beside : path.beside) {
      part(path.component.c_str(), beside.kind.c_str(), static_cast<double>(path.parts(beside)), 1);
      operations(path.component.c_str(), beside.kind.c_str(),
                 static_cast<double>(items) * beside.operations);
    }
    const auto between = [&](const char* kind, std::uint32_t bits, std::uint32_t of_item) {
      if (bits == 0) return;
      part(path.component.c_str(), kind, static_cast<double>(path.copies) * bits, 1);
      operations(path.component.c_str(), kind, static_cast<double>(items) * of_item);
    };
    part(path.component.c_str(), "register_bit", path.set_bits, 1);
    between("register_bit", path.between.registers, path.between.written);
    between("select_bit", path.between.multiplexers, path.between.selected);
    const auto same =
        std::find_if(into_.datapaths.begin(), into_.datapaths.end(),
                     [&](const DatapathResult& d) { return d.datapath.name == path.name; });
    if (same != into_.datapaths.end()) {
      same->datapath.copies += path.copies;
      same->datapath.set_bits += path.set_bits;
      same->items += items;
      same->busiest_cycles = std::max(same->busiest_cycles, path.cycles(items));
    } else {
      into_.datapaths.push_back({path, items, path.cycles(items)});
    }
  }
  void part(const char* component, const char* kind, double count, double per_cycle) override {
    for (std::vector<Parts>* all : {&into_.parts, &into_.owners[owner_].parts}) {
      Parts& parts = entry(*all, component, kind);
      parts.count += count;
      parts.per_cycle += count * per_cycle;
    }
  }
  void operations(const char* component, const char* kind, double count) override {
    entry(into_.operations, component, kind).count += count;
    if (count > 0) into_.units.back().charged = true;
  }
  void sram(const SramUse& use) override {
    if (use.name.rfind(kOutstandingTable, 0) == 0) table_ = use.name;
    sgs::add(into_.sram_uses, use);
    sgs::add(into_.owners[owner_].sram_uses, use);
  }
  void accesses(const char* use, std::uint64_t reads, std::uint64_t writes) override {
    SramAccesses& same = accesses_of(use);
    same.reads += reads;
    same.writes += writes;
    if (reads + writes > 0) into_.units.back().charged = true;
  }
  void queue(FifoChannel& queue, const char* use) override {
    if (queue.entry_bytes() == 0) return;
    accesses(use, queue.popped(), queue.pushed());
    SramPeak& seen = accesses_of(use).seen;
    seen.reads = std::max(seen.reads, queue.most_popped());
    seen.writes = std::max(seen.writes, queue.most_pushed());
    // Whoever puts entries in or takes them out is charged with that, wherever the queue is said.
    for (const Activity* end : {queue.writer(), queue.reader()}) {
      if (end != nullptr) movers_.insert(path_below(*end->get_parent_object(), machine_));
    }
  }
  void port(MemoryPort& port, const char* writes) override {
    accesses(table_.c_str(), port.transactions(), port.transactions());
    by_part(kBytesOfParts, "bytes", "asked for, read and written", port.bytes_of_parts());
    if (*writes != '\0') accesses(writes, port.words_written(), port.words_written());
  }
  void sram_available(const char* memory, std::uint64_t bytes) override {
    into_.sram_available.emplace_back(memory, bytes);
  }

  // To be called when all units have published: what concerns the ends of a FIFO comes from who
  // made it, not from who is there.
  void join_ends() {
    for (UnitResult& unit : into_.units) unit.charged |= movers_.count(unit.name) > 0;
    apply_remedies();
  }

 private:
  SramAccesses& accesses_of(const std::string& use) {
    auto same = std::find_if(into_.sram_accesses.begin(), into_.sram_accesses.end(),
                             [&](const SramAccesses& a) { return a.use == use; });
    if (same == into_.sram_accesses.end()) {
      same = into_.sram_accesses.insert(same, {use, 0, 0, {0, 0}});
    }
    return *same;
  }

  void apply_remedies() {
    const auto in = [](const auto& remedies, const auto& at) {
      const auto found = remedies.find(at);
      return found == remedies.end() ? Remedy() : found->second;
    };
    for (UnitResult& unit : into_.units) {
      for (ActivityResult& activity : unit.activities) {
        activity.remedy = in(for_work_, unit.name + "." + activity.name);
        for (WaitResult& wait : activity.waits) {
          // More entries are what helps both ends of a FIFO.
          const bool at_fifo = wait.what == WaitFor::kInput;
          wait.remedy = in(for_waits_, std::pair(wait.at, at_fifo ? WaitFor::kRoom : wait.what));
        }
      }
    }
  }

  WaitResult wait_of(const Activity::Wait& wait, const Activity& waiting) const {
    WaitResult result{wait.what, "", "", {}, wait.cycles};
    if (wait.at != nullptr) result.at = path_below(*wait.at, machine_);
    if (const auto* fifo = dynamic_cast<const FifoChannel*>(wait.at)) {
      const Activity* other = fifo->writer() == &waiting ? fifo->reader() : fifo->writer();
      if (other != nullptr) result.other = path_below(*other, machine_);
    }
    return result;
  }

  template <class Entry>
  static Entry& entry(std::vector<Entry>& entries, const char* component, const char* kind) {
    const auto same = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) {
      return e.component == component && e.kind == kind;
    });
    if (same != entries.end()) return *same;
    Entry fresh;
    fresh.component = component;
    fresh.kind = kind;
    entries.push_back(fresh);
    return entries.back();
  }

  const Machine& machine_;
  MachineResult& into_;
  std::size_t owner_ = 0;         // index of the publishing unit's owner
  std::string table_;             // of its ports' transactions: all of a machine have one name
  std::set<std::string> movers_;  // units at an end of a FIFO that entries went through
  std::map<std::string, Remedy> for_work_;
  std::map<std::pair<std::string, WaitFor>, Remedy> for_waits_;
};

class Drained : public DataSheet {
 public:
  void queue(FifoChannel& queue, const char*) override { all = all && queue.fill() == 0; }
  void port(MemoryPort& port, const char*) override { all = all && port.idle(); }
  bool all = true;
};

}  // namespace

std::uint64_t ActivityResult::waited_for(WaitFor what) const {
  std::uint64_t sum = 0;
  for (const WaitResult& wait : waits) sum += wait.what == what ? wait.cycles : 0;
  return sum;
}

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
  return collect(machine, [&](DataSheet& sheet) { machine.publish(sheet); });
}

MachineResult collect(const Machine& machine, const Publisher& all) {
  MachineResult result;
  Collector collector(machine, result);
  all(collector);
  collector.join_ends();
  std::uint64_t idle = 0;
  for (const UnitResult& unit : result.units) {
    for (const ActivityResult& activity : unit.activities) idle += activity.busy_cycles == 0;
  }
  for (const auto& [memory, available] : result.sram_available) {
    const std::uint64_t used = sram_bytes(result.sram_uses, memory);
    if (used >= available) continue;
    collector.left_out(("unused_sram_" + memory).c_str(), "configured, and taken by no unit",
                       available - used, "bytes that are not built: no area, no leakage");
  }
  collector.left_out("idle_activities", "never fed in this frame", idle,
                     "what only they use, if every frame is like this one");
  const auto is_empty = [](const UnitResult& unit) {
    return unit.activities.empty() && unit.counters.empty();
  };
  result.units.erase(std::remove_if(result.units.begin(), result.units.end(), is_empty),
                     result.units.end());
  return result;
}

bool drained(const Publisher& all) {
  Drained sheet;
  all(sheet);
  return sheet.all;
}

std::string path_below(const sc_core::sc_object& object, const Machine& machine) {
  const std::string above = std::string(machine.name()) + ".";
  const std::string name = object.name();
  return name.compare(0, above.size(), above) == 0 ? name.substr(above.size()) : name;
}

}  // namespace sgs

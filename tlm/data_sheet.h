// The data sheet of a unit: everything it publishes about itself, said once. Reports, energy, area,
// waveforms and the tables of the documentation are visitors of it.
//
//   void ExactSorter::publish(DataSheet& sheet) {
//     sheet.unit(*this);
//     sheet.activity(sort_, "sorting", "takes, sorts and hands on the keys of one chunk");
//     sheet.counters(counters_);
//     sheet.part("sorting", "comparator", kNetworkComparators, 1);
//     sheet.operations("sorting", "comparator", counters_.compare_exchanges);
//     sheet.sram(sram_uses(built_for_));
//     sheet.accesses("key sorters", counters_.keys, counters_.keys);
//   }
//
// It is a ledger of hardware and of its use. Arithmetic is done by the lanes of a datapath, other
// operations by parts of their kind, reads and writes by the memory of a use. So area, energy and a
// bound on time follow from the same lines (testbench/result/ledger.h).
#pragma once

#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "tlm/counter.h"
#include "tlm/datapath.h"
#include "tlm/memory_port.h"
#include "tlm/remedy.h"
#include "tlm/sram_use.h"
#include "tlm/timed_fifo.h"

namespace sgs {

// All that follows a unit() belongs to it. Nothing is kept by name and value alone that is needed
// later: activities, queues, ports and signals are passed by reference and live with the unit.
class DataSheet {
 public:
  virtual ~DataSheet() = default;

  virtual void unit(const sc_core::sc_object&) {}

  // resource: what the activity keeps busy. A resource is as busy as its busiest activity.
  virtual void activity(Activity&, const char* resource, const char* meaning) {
    (void)resource;
    (void)meaning;
  }
  // A parameter that reduces the activity's busy cycles; or its waiting cycles, for something at a
  // FIFO, a port or a unit.
  virtual void remedy(const Activity&, const Remedy&) {}
  virtual void remedy(const sc_core::sc_object& at, WaitFor what, const Remedy&) {
    (void)at;
    (void)what;
  }
  // A parameter that may help the unit as well, though no wait points to it: for a search that
  // tries all.
  virtual void may_help(const Remedy&) {}
  // The unit's own counters, and a value that something else has counted for it. unit: of the
  // value.
  void counters(const CounterSet& set) {
    for (const Counter* c : set.all()) counter(c->name(), c->unit(), c->meaning(), *c);
  }
  virtual void counter(const char* name, const char* unit, const char* meaning,
                       std::uint64_t value) {
    (void)name;
    (void)unit;
    (void)meaning;
    (void)value;
  }
  // A value for each part of the frame, numbered as in MemoryPort::charge_to(). The values of
  // several units with one name are added up.
  virtual void by_part(const char* name, const char* unit, const char* meaning,
                       const std::vector<std::uint64_t>& values) {
    (void)name;
    (void)unit;
    (void)meaning;
    (void)values;
  }
  // Lanes that stand there, and how many items have passed them: area and leakage of the lanes,
  // energy of the items, and items x macs / lanes as a bound on the cycles.
  virtual void datapath(const Datapath&, std::uint64_t items) { (void)items; }
  // Hardware beside lanes and SRAM. component: whose square millimetres; kind: a row of the
  // technology table; per_cycle: operations that each can do a cycle.
  virtual void part(const char* component, const char* kind, double count, double per_cycle) {
    (void)component;
    (void)kind;
    (void)count;
    (void)per_cycle;
  }
  // Operations done so far by the parts of this component and kind.
  virtual void operations(const char* component, const char* kind, double count) {
    (void)component;
    (void)kind;
    (void)count;
  }
  // On-chip memory that the unit takes, whatever the scene and the frame: area and leakage.
  virtual void sram(const SramUse&) {}
  void sram(const SramUses& uses) {
    for (const SramUse& use : uses) sram(use);
  }
  // Reads and writes so far, each of the use's width, of one of the unit's uses. Queues and ports
  // say theirs themselves. A use that nobody accesses has a line with zeros.
  virtual void accesses(const char* use, std::uint64_t reads, std::uint64_t writes) {
    (void)use;
    (void)reads;
    (void)writes;
  }
  // Bytes of an on-chip memory that may be used: what uses do not take of it is not built.
  virtual void sram_available(const char* memory, std::uint64_t bytes) {
    (void)memory;
    (void)bytes;
  }
  // Operations or accesses that were not needed. what: key of the saving, the same for every unit
  // that knows it.
  virtual void left_out(const char* what, const char* why, std::uint64_t count,
                        const std::string& saves) {
    (void)what;
    (void)why;
    (void)count;
    (void)saves;
  }
  // use: the name of the unit's SramUse that holds its entries: its accesses are what the queue
  // takes in and gives out. A queue whose entries take no bytes stands for them: the unit says the
  // accesses.
  virtual void queue(FifoChannel&, const char* use) { (void)use; }
  // The unit says the SRAM of its outstanding transactions (outstanding_table). writes: the name of
  // the unit's SramUse that keeps unanswered writes; none for a port that only reads.
  virtual void port(MemoryPort&, const char* writes) { (void)writes; }
  void port(MemoryPort& reads_only) { port(reads_only, ""); }
  // A fill that changes over time, for the waveform and for timelines: keys that wait. unit: of the
  // value.
  virtual void level(const char* name, const char* unit, const std::uint32_t& value) {
    (void)unit;
    signal(name, value);
  }
  // A value for the waveform, under the unit's name.
  virtual void signal(const char* name, const std::uint32_t& value) {
    (void)name;
    (void)value;
  }
  virtual void signal(const char* name, const bool& value) {
    (void)name;
    (void)value;
  }
};

}  // namespace sgs

// What a unit says of itself, once: its data sheet. Reports, energy, area, waveforms and the tables
// of the documentation are visitors of it.
//
//   void ExactSorter::publish(DataSheet& sheet) {
//     sheet.unit(*this);
//     sheet.activity(sort_, "sorting", "takes, sorts and hands on the keys of one chunk");
//     sheet.counter("keys", "keys", "sorted", counters_.keys);
//     sheet.operations("sorting", "compare_exchange", counters_.compare_exchanges);
//     sheet.part("sorting", "sorting_unit", 1);
//     sheet.sram(sram_uses(built_for_));
//   }
#pragma once

#include <cstdint>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "tlm/memory_port.h"
#include "tlm/sram_use.h"
#include "tlm/timed_fifo.h"

namespace sgs {

// What one operation of a datapath executes, counted by running it.
struct Datapath {
  std::string name;
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // by class of operation
  // Multiply-accumulates: counted, published, charged; and how many are done a cycle.
  std::uint32_t counted_macs = 0, published_macs = 0, used_macs = 0, lanes = 1;
};

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
  // What to change in the configuration, key: of which more lets the activity work for fewer
  // cycles; or wait for fewer, for something at a FIFO, a port or a unit.
  virtual void remedy(const Activity&, const char* key) { (void)key; }
  virtual void remedy(const sc_core::sc_object& at, WaitFor what, const char* key) {
    (void)at;
    (void)what;
    (void)key;
  }
  // unit: of the value ("cycles", "bytes", "keys").
  virtual void counter(const char* name, const char* unit, const char* meaning,
                       std::uint64_t value) {
    (void)name;
    (void)unit;
    (void)meaning;
    (void)value;
  }
  // Work done so far, for energy. component: whose joules; kind: a row of the technology table.
  virtual void operations(const char* component, const char* kind, double count) {
    (void)component;
    (void)kind;
    (void)count;
  }
  // What stands there beside SRAM, for area and leakage. component: whose square millimetres; kind:
  // as above.
  virtual void part(const char* component, const char* kind, double count) {
    (void)component;
    (void)kind;
    (void)count;
  }
  // On-chip memory that the unit takes, whatever the scene and the frame.
  virtual void sram(const SramUse&) {}
  void sram(const SramUses& uses) {
    for (const SramUse& use : uses) sram(use);
  }
  // Bytes of an on-chip memory that stand there, used or not. Its area and leakage follow from it.
  virtual void sram_available(const char* memory, std::uint64_t bytes) {
    (void)memory;
    (void)bytes;
  }
  virtual void datapath(const Datapath&) {}
  // Work that was not needed. what: key of the saving, the same for every unit that knows it.
  virtual void left_out(const char* what, const char* why, std::uint64_t count,
                        const std::string& saves) {
    (void)what;
    (void)why;
    (void)count;
    (void)saves;
  }
  // use: the name of the unit's SramUse that holds its entries.
  virtual void queue(FifoChannel&, const char* use) { (void)use; }
  virtual void port(MemoryPort&) {}
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

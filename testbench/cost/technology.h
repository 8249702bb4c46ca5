// Cost of hardware: area of each part in mm2, energy of each operation in joules. A table of data
// that a user can replace.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "testbench/cost/band.h"
#include "testbench/cost/sram_model.h"

namespace sgs {

// A part of logic, and one operation that it does.
struct PartCost {
  Band mm2, pj;
  std::string source;
};

// Cost of the die beneath all parts, by area.
struct DieCost {
  Band clock_pj_mm2_cycle;  // clock tree and registers, of logic
  Band logic_leakage_mw_mm2;
  std::string source;
};

// PHY and controller of one channel of the memory, on the accelerator's die. Those of another
// memory go by its peak bandwidth: PHYs by pins and data rate.
struct MemoryInterfaceCost {
  bool counted = false;
  std::string memspec;  // whose they are: how the names of its memspecs begin; empty: not told
  double gb_s = 0;      // peak of that channel
  Band mm2, mw;
  // Of writes that wait, by the default of dram.write_queue_entries; on-chip memory, beside these.
  std::uint64_t write_queue_bytes = 0;
  std::string source;
};

struct Technology {
  std::string path;                       // the table's file, for messages
  std::string name;                       // the node's name
  std::map<std::string, PartCost> parts;  // by kind
  SramModel sram;
  DieCost die;
  MemoryInterfaceCost memory_interface;

  // Throws InputError, naming the kind, where the table has no such row.
  const PartCost& part(const std::string& kind) const;
};

void visit(ConfigVisitor& v, PartCost& cost);
void visit(ConfigVisitor& v, DieCost& cost);
void visit(ConfigVisitor& v, MemoryInterfaceCost& cost);
void visit(ConfigVisitor& v, Technology& technology);

// Throws InputError, also for a table without a name or one of its numbers, and for a band that is
// not low <= middle <= high.
Technology load_technology(const std::string& path);

}  // namespace sgs

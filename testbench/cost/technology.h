// Cost of hardware: area of each part in mm2, energy of each operation in joules. A table of data
// that a user can replace.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>

#include "modules/config/config_visitor.h"
#include "tlm/sram_use.h"

namespace sgs {

// An amount that is known within bounds: what the sources allow at least, what is taken, and what
// they allow at most.
struct Band {
  double low = 0, middle = 0, high = 0;
};

constexpr Band operator+(const Band& a, const Band& b) {
  return {a.low + b.low, a.middle + b.middle, a.high + b.high};
}
constexpr Band operator*(const Band& a, const Band& b) {
  return {a.low * b.low, a.middle * b.middle, a.high * b.high};
}
constexpr Band operator*(double factor, const Band& a) {
  return {factor * a.low, factor * a.middle, factor * a.high};
}

// "6.50 (4.88 .. 9.50)"
inline std::string in_words(const Band& band) {
  return fmt::format("{:.2f} ({:.2f} .. {:.2f})", band.middle, band.low, band.high);
}

inline void visit(ConfigVisitor& v, Band& band) {
  const ConfigRange range = in_range(0, 1e9);
  v("low", band.low, range, "least that the sources allow");
  v("middle", band.middle, range, "taken");
  v("high", band.high, range, "most that the sources allow");
}

// Area, energy of an access and leakage of an on-chip memory, by capacity, width and ports: one
// formula fitted to published points, which stand beside it in the technology table.

// A memory that somebody has published. um2, pj: as published, 0 where it is not; um2_scale,
// pj_scale: from its node to the table's.
struct SramPoint {
  double bits = 0, width_bits = 0, ports = 1;
  double um2 = 0, um2_scale = 1;
  double pj = 0, pj_scale = 1;
  std::string source;
};

// A pair of published memories of one source, node and size: with one port, and with two. The
// source says what the ports do.
struct SramPair {
  double bits = 0, width_bits = 0;
  double one_um2 = 0, two_um2 = 0;
  std::string source;
};

// Area and energy of one bank with C bits, W of them accessed at once, and P ports:
//   um2 = (C um2_bit + W um2_width) second_port^(P - 1)
//   pJ of a read = W (pj_width + pj_cell sqrt(C)) + pj_decode sqrt(C)
// sqrt(C) stands for the length of word lines, bit lines and the way there. The points are at most
// 256 bits wide; a wider bank is made of macros of at most so many, side by side. None has fewer
// than least_rows rows: a shorter bank is a macro of so many, or registers where its use says so.
struct SramModel {
  double um2_bit = 0, um2_width = 0;
  double pj_width = 0, pj_cell = 0, pj_decode = 0;
  double least_rows = 0;
  Band um2_register;   // one bit in registers with its share of what reads them, on a die
  Band second_port;    // area with two ports over that with one
  Band macro;          // area of a macro over that of the formula
  Band placed;         // area on a die over that of the bare macro
  Band access;         // energy over that of the formula
  Band write_of_read;  // energy of a write over that of a read
  Band leakage_mw_kib;
  std::string source;
  std::map<std::string, SramPoint> points;
  std::map<std::string, SramPair> pairs;

  static constexpr std::uint32_t kMacroBits = 256;

  Band bare_um2(double bits, double width_bits, double ports) const;
  double bare_read_pj(double bits, double width_bits) const;

  // Area of all banks of the use, on the die. An access of registers is charged as one of the macro
  // that they replace.
  Band mm2(const SramUse& use) const;
  Band leakage_mw(const SramUse& use) const;  // macros only: registers leak as the logic does
  Band read_pj(const SramUse& use) const;     // one access of one bank
  Band write_pj(const SramUse& use) const;
};

void visit(ConfigVisitor& v, SramPoint& point);
void visit(ConfigVisitor& v, SramPair& pair);
void visit(ConfigVisitor& v, SramModel& model);

// A part of logic, and one operation that it does. An operation clocks each of its register bits
// once.
struct PartCost {
  Band mm2, pj;
  double register_bits = 0;
  std::string source;
};

// Rows of the technology table for the clock: of a register bit, what a cycle takes that it is
// clocked in; of a gate, what each cycle takes.
constexpr const char *kRegisterClock = "register_clock", *kClockGate = "clock_gate";
// Register bits that one gate gives the clock: a word.
constexpr double kGatedBits = 32;

// Cost of the die beneath all parts, by area.
struct DieCost {
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
  std::string note;                       // what it says that has no effect; empty: nothing
  std::string name;                       // the node's name
  double clock_mhz = 0;                   // that its rows and depths of pipelines stand for; 0: any
  std::map<std::string, PartCost> parts;  // by kind
  // What literature says where the parts go by gates, and what other rows are made of: in no cost.
  std::map<std::string, PartCost> published;
  SramModel sram;
  DieCost die;
  MemoryInterfaceCost memory_interface;

  // Throws InputError, naming the kind, where the table has no such row.
  const PartCost& part(const std::string& kind) const;
  // Of one, with the clock gates of its registers. Throws as above.
  Band mm2(const std::string& kind) const;
};

void visit(ConfigVisitor& v, PartCost& cost);
void visit(ConfigVisitor& v, DieCost& cost);
void visit(ConfigVisitor& v, MemoryInterfaceCost& cost);
void visit(ConfigVisitor& v, Technology& technology);

// Throws InputError, also for a table without a name, a source, or one of its numbers, for a band
// that is not low <= middle <= high, and for parts of other kinds than the shipped table's.
Technology load_technology(const std::string& path);

}  // namespace sgs

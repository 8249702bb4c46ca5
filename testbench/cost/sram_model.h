// Area, energy of an access and leakage of an on-chip memory, by capacity, width and ports: one
// formula fitted to published points, which stand beside it in the technology table.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "testbench/cost/band.h"
#include "tlm/sram_use.h"

namespace sgs {

// A memory that somebody has published. um2, pj: as published, 0 where it is not; um2_scale,
// pj_scale: from its node to the table's.
struct SramPoint {
  double bits = 0, width_bits = 0, ports = 1;
  double um2 = 0, um2_scale = 1;
  double pj = 0, pj_scale = 1;
  std::string source;
};

// Area and energy of one bank with C bits, W of them accessed at once, and P ports:
//   um2 = C (um2_bit + um2_bit_port (P - 1)) + W um2_width
//   pJ of a read = W (pj_width + pj_cell sqrt(C)) + pj_decode sqrt(C)
// sqrt(C) stands for the length of word lines, bit lines and the way there. The points are at most
// 256 bits wide; a wider bank is made of macros of at most so many, side by side. None has fewer
// than least_rows rows: a shorter bank is a macro of so many, or registers where its use says so.
struct SramModel {
  double um2_bit = 0, um2_bit_port = 0, um2_width = 0;
  double pj_width = 0, pj_cell = 0, pj_decode = 0;
  double least_rows = 0;
  Band um2_register;   // one bit in registers with its share of what reads them, on a die
  Band macro;          // area of a macro over that of the formula
  Band placed;         // area on a die over that of the bare macro
  Band access;         // energy over that of the formula
  Band write_of_read;  // energy of a write over that of a read
  Band leakage_mw_kib;
  std::string source;
  std::map<std::string, SramPoint> points;

  static constexpr std::uint32_t kMacroBits = 256;

  double bare_um2(double bits, double width_bits, double ports) const;
  double bare_read_pj(double bits, double width_bits) const;

  // Area of all banks of the use, on the die. An access of registers is charged as one of the macro
  // that they replace.
  Band mm2(const SramUse& use) const;
  Band leakage_mw(const SramUse& use) const;  // macros only: registers leak as the logic does
  Band read_pj(const SramUse& use) const;     // one access of one bank
  Band write_pj(const SramUse& use) const;
};

void visit(ConfigVisitor& v, SramPoint& point);
void visit(ConfigVisitor& v, SramModel& model);

}  // namespace sgs

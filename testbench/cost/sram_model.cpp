// The formula, and its fields in the table.
#include "testbench/cost/sram_model.h"

#include <algorithm>
#include <cmath>

namespace sgs {
namespace {

double bank_bits(const SramUse& use) {
  return 8.0 * static_cast<double>(use.bytes) / use.shape.banks;
}
double ports(const SramUse& use) { return use.shape.ports == SramPorts::kOne ? 1 : 2; }
double banks(const SramUse& use) { return static_cast<double>(use.count) * use.shape.banks; }

// Bits of a bank's macros, including rows that nobody uses.
double macro_bits(const SramModel& model, const SramUse& use) {
  return std::max(bank_bits(use), model.least_rows * use.shape.width_bits);
}

Band macro_um2(const SramModel& model, const SramUse& use) {
  return model.bare_um2(macro_bits(model, use), use.shape.width_bits, ports(use)) * model.macro *
         model.placed;
}

Band register_um2(const SramModel& model, const SramUse& use) {
  return bank_bits(use) * model.um2_register;
}

}  // namespace

double SramModel::bare_um2(double bits, double width_bits, double port_count) const {
  return bits * (um2_bit + um2_bit_port * (port_count - 1)) + width_bits * um2_width;
}

double SramModel::bare_read_pj(double bits, double width_bits) const {
  const double length = std::sqrt(bits);
  return width_bits * (pj_width + pj_cell * length) + pj_decode * length;
}

Band SramModel::mm2(const SramUse& use) const {
  constexpr double kMm2 = 1e-6;  // mm2 in a um2
  return kMm2 * banks(use) *
         (use.in_registers() ? register_um2(*this, use) : macro_um2(*this, use));
}

Band SramModel::leakage_mw(const SramUse& use) const {
  constexpr double kKiB = 8 * 1024;  // bits
  if (use.in_registers()) return {};
  return banks(use) * macro_bits(*this, use) / kKiB * leakage_mw_kib;
}

Band SramModel::read_pj(const SramUse& use) const {
  const std::uint32_t macros = (use.shape.width_bits + kMacroBits - 1) / kMacroBits;
  return static_cast<double>(macros) *
         bare_read_pj(macro_bits(*this, use) / macros,
                      use.shape.width_bits / static_cast<double>(macros)) *
         access;
}

Band SramModel::write_pj(const SramUse& use) const { return read_pj(use) * write_of_read; }

void visit(ConfigVisitor& v, SramPoint& p) {
  const ConfigRange amount = in_range(0, 1e12);
  v("bits", p.bits, in_range(1, 1e12), "capacity");
  v("width_bits", p.width_bits, in_range(1, 1e6), "of an access");
  v("ports", p.ports, in_range(1, 2), "accesses a cycle");
  v("um2", p.um2, amount, "area as published; 0: not published");
  v("um2_scale", p.um2_scale, in_range(0, 1e3), "to this table's node");
  v("pj", p.pj, amount, "energy of a read as published; 0: not published");
  v("pj_scale", p.pj_scale, in_range(0, 1e3), "to this table's node");
  v("source", p.source, "where the numbers are from");
}

void visit(ConfigVisitor& v, SramModel& m) {
  const ConfigRange range = in_range(0, 1e6);
  v("um2_bit", m.um2_bit, range, "area of a bit");
  v("um2_bit_port", m.um2_bit_port, range, "more of it for a second port");
  v("um2_width", m.um2_width, range, "area of a bit of width");
  v("pj_width", m.pj_width, range, "energy of a bit accessed");
  v("pj_cell", m.pj_cell, range, "the same, times the root of the bits of a bank");
  v("pj_decode", m.pj_decode, range, "energy of an access, times the root of the bits of a bank");
  v("least_rows", m.least_rows, range, "of a macro");
  v.section("um2_register", m.um2_register, "area of a bit kept in registers, on a die");
  v.section("macro", m.macro, "area of a macro over that of the formula");
  v.section("placed", m.placed, "area on a die over that of the macro");
  v.section("access", m.access, "energy over that of the formula");
  v.section("write_of_read", m.write_of_read, "energy of a write over that of a read");
  v.section("leakage_mw_kib", m.leakage_mw_kib, "milliwatts that a KiB leaks");
  v("source", m.source, "where the numbers are from, and how sure they are");
  v.sections("points", m.points, "published memories that the formula is fitted to");
}

}  // namespace sgs

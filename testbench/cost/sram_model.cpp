// The formula, and its fields in the table.
#include "testbench/cost/sram_model.h"

#include <cmath>

namespace sgs {
namespace {

double bank_bits(const SramUse& use) {
  return 8.0 * static_cast<double>(use.bytes) / use.shape.banks;
}
double ports(const SramUse& use) { return use.shape.ports == SramPorts::kOne ? 1 : 2; }

}  // namespace

double SramModel::bare_um2(double bits, double width_bits, double port_count) const {
  return bits * (um2_bit + um2_bit_port * (port_count - 1)) + width_bits * um2_width;
}

double SramModel::bare_read_pj(double bits, double width_bits) const {
  const double length = std::sqrt(bits);
  return width_bits * (pj_width + pj_cell * length) + pj_decode * length;
}

Band SramModel::mm2(const SramUse& use) const {
  constexpr double kMm2 = 1e-6;  // of a um2
  const double banks = static_cast<double>(use.count) * use.shape.banks;
  return kMm2 * banks * bare_um2(bank_bits(use), use.shape.width_bits, ports(use)) * macro * placed;
}

Band SramModel::leakage_mw(const SramUse& use) const {
  constexpr double kKiB = 1024;
  return static_cast<double>(use.total_bytes()) / kKiB * leakage_mw_kib;
}

Band SramModel::read_pj(const SramUse& use) const {
  const std::uint32_t macros = (use.shape.width_bits + kMacroBits - 1) / kMacroBits;
  return static_cast<double>(macros) *
         bare_read_pj(bank_bits(use) / macros, use.shape.width_bits / static_cast<double>(macros)) *
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
  v.section("macro", m.macro, "area of a macro over that of the formula");
  v.section("placed", m.placed, "area on a die over that of the macro");
  v.section("access", m.access, "energy over that of the formula");
  v.section("write_of_read", m.write_of_read, "energy of a write over that of a read");
  v.section("leakage_mw_kib", m.leakage_mw_kib, "milliwatts that a KiB leaks");
  v("source", m.source, "where the numbers are from, and how sure they are");
  v.sections("points", m.points, "published memories that the formula is fitted to");
}

}  // namespace sgs

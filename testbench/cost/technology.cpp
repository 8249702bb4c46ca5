// Reading of technology tables.
#include "testbench/cost/technology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "modules/config/strict_json.h"

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

using Json = nlohmann::ordered_json;

// Throws InputError unless `stated` has each number of the table: what it lacks would cost nothing.
// A clock may stay untold.
// Published memories and parts are in no cost. at: path of the keys.
void check_stated(const Json& table, const std::string& at, const std::set<std::string>& stated,
                  const std::string& path) {
  for (const auto& [key, value] : table.items()) {
    const std::string place = at.empty() ? key : at + "." + key;
    const bool in_no_cost = place == "sram.points" || place == "sram.pairs" || place == "published";
    if (in_no_cost || place == "clock_mhz" || key == "source") continue;
    if (value.is_object()) {
      check_stated(value, place, stated, path);
    } else if (!value.is_string() && stated.count(place) == 0) {
      throw InputError(fmt::format("{}: {}: got nothing, expected it", path, place));
    }
  }
}

// Throws InputError unless every object that has room for a source tells one. at: path of the keys.
void check_sources(const Json& table, const std::string& at, const std::string& path) {
  for (const auto& [key, value] : table.items()) {
    const std::string place = at.empty() ? key : at + "." + key;
    if (value.is_object()) check_sources(value, place, path);
    if (key == "source" && value == "")
      throw InputError(
          fmt::format("{}: {}: got nothing, expected where these numbers come from", path, place));
  }
}

std::vector<std::string> names_of(const Json& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows.items()) names.push_back(row.key());
  return names;
}

// The kinds of part are the rows of the shipped table. Throws InputError for another row, which no
// part would take, and without one of them.
void check_rows(const Technology& technology, const Json& shipped) {
  const std::vector<std::string> kinds = names_of(shipped.at("parts"));
  for (const auto& [kind, cost] : technology.parts) {
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) continue;
    throw InputError(fmt::format("{}: parts.{}: no kind of part{}one of {}", technology.path, kind,
                                 then_expected(did_you_mean(kind, kinds)), join(kinds)));
  }
  for (const std::string& kind : kinds) technology.part(kind);
}

// A line about published constants and memories that are not the shipped table's; empty: none.
// The order of their keys says nothing.
std::string note_on_published(const nlohmann::json& given, const nlohmann::json& shipped,
                              const std::string& path) {
  std::vector<std::string> changed;
  for (const std::string section : {"published", "sram.points", "sram.pairs"}) {
    std::string pointer = "/" + section;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const nlohmann::json::json_pointer at(pointer);
    const nlohmann::json rows = given.value(at, nlohmann::json::object());
    const nlohmann::json ours = shipped.value(at, nlohmann::json::object());
    for (const auto& [name, row] : rows.items())
      if (!ours.contains(name) || ours.at(name) != row) changed.push_back(section + "." + name);
  }
  return changed.empty() ? "" : fmt::format("{}: {}: no cost is made of it", path, join(changed));
}

// at: path of the keys.
void check_bands(const Json& json, const std::string& at, const std::string& path) {
  if (json.contains("low")) {
    const double low = json["low"], middle = json["middle"], high = json["high"];
    if (low <= middle && middle <= high) return;
    throw InputError(
        fmt::format("{}: {}: got low {}, middle {}, high {}, expected them in this order", path, at,
                    low, middle, high));
  }
  for (const auto& [key, value] : json.items()) {
    if (value.is_object()) check_bands(value, at.empty() ? key : at + "." + key, path);
  }
}

}  // namespace

Band SramModel::bare_um2(double bits, double width_bits, double port_count) const {
  const double one_port = bits * um2_bit + width_bits * um2_width;
  return one_port * (port_count == 2 ? second_port : Band{1, 1, 1});
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

void visit(ConfigVisitor& v, SramPair& p) {
  const ConfigRange um2 = in_range(1e-6, 1e12);
  v("bits", p.bits, in_range(1, 1e12), "capacity");
  v("width_bits", p.width_bits, in_range(1, 1e6), "of an access");
  v("one_um2", p.one_um2, um2, "area with one port, as published");
  v("two_um2", p.two_um2, um2, "area with two");
  v("source", p.source, "where the numbers are from, and what the ports do");
}

void visit(ConfigVisitor& v, SramModel& m) {
  const ConfigRange range = in_range(0, 1e6);
  v("um2_bit", m.um2_bit, range, "area of a bit");
  v("um2_width", m.um2_width, range, "area of a bit of width");
  v("pj_width", m.pj_width, range, "energy of a bit accessed");
  v("pj_cell", m.pj_cell, range, "the same, times the root of the bits of a bank");
  v("pj_decode", m.pj_decode, range, "energy of an access, times the root of the bits of a bank");
  v("least_rows", m.least_rows, range, "of a macro");
  v.section("second_port", m.second_port, "area with two ports over that with one");
  v.section("um2_register", m.um2_register, "area of a bit kept in registers, on a die");
  v.section("macro", m.macro, "area of a macro over that of the formula");
  v.section("placed", m.placed, "area on a die over that of the macro");
  v.section("access", m.access, "energy over that of the formula");
  v.section("write_of_read", m.write_of_read, "energy of a write over that of a read");
  v.section("leakage_mw_kib", m.leakage_mw_kib, "milliwatts that a KiB leaks");
  v("source", m.source, "where the numbers are from, and how sure they are");
  v.sections("points", m.points, "published memories that the formula is fitted to");
  v.sections("pairs", m.pairs, "published memories with one port and with two");
}

const PartCost& Technology::part(const std::string& kind) const {
  const auto at = parts.find(kind);
  if (at != parts.end()) return at->second;
  throw InputError(fmt::format(
      "{}: parts: got no row \"{}\", expected one for all that a machine is made of", path, kind));
}

Band Technology::mm2(const std::string& kind) const {
  const PartCost& of = part(kind);
  return of.register_bits == 0 ? of.mm2
                               : of.mm2 + of.register_bits / kGatedBits * part(kClockGate).mm2;
}

void visit(ConfigVisitor& v, PartCost& cost) {
  v.section("mm2", cost.mm2, "square millimetres of one");
  v.section("pj", cost.pj, "picojoules of one operation, without its clock");
  v("register_bits", cost.register_bits, in_range(0, 1e9), "flip-flops in one");
  v("source", cost.source, "where the numbers are from, and how sure they are");
}

void visit(ConfigVisitor& v, DieCost& cost) {
  v.section("logic_leakage_mw_mm2", cost.logic_leakage_mw_mm2,
            "milliwatts that a square millimetre of logic leaks");
  v("source", cost.source, "where the numbers are from, and how sure they are");
}

void visit(ConfigVisitor& v, MemoryInterfaceCost& cost) {
  v("counted", cost.counted, "whether it is part of area and energy");
  v("memspec", cost.memspec, "memory that they are of: how the names of its memspecs begin");
  v("gb_s", cost.gb_s, in_range(1e-3, 1e6),
    "peak bandwidth of the channel that mm2 and mw are of: others take them in proportion");
  v.section("mm2", cost.mm2, "square millimetres of one channel");
  v.section("mw", cost.mw, "milliwatts of one channel, apart from what moves bits");
  v("write_queue_bytes", cost.write_queue_bytes, in_range(0, 1 << 30),
    "of writes that wait in the controller of one channel, at the default of "
    "dram.write_queue_entries: on-chip memory, beside the above");
  v("source", cost.source, "where the numbers are from, and how sure they are");
}

void visit(ConfigVisitor& v, Technology& technology) {
  v("name", technology.name, "of the node");
  v("clock_mhz", technology.clock_mhz, in_range(0, 10000),
    "fastest clock that the table and the depths of pipelines stand for; 0: not told");
  v.sections("parts", technology.parts, "logic, by kind");
  v.sections("published", technology.published, "published constants of parts, in no cost");
  v.section("sram", technology.sram, "on-chip memory");
  v.section("die", technology.die, "by area");
  v.section("memory_interface", technology.memory_interface, "of each memory channel");
}

Technology load_technology(const std::string& path) {
  ConfigDocument document;
  document.add_file(path);
  Technology technology;
  document.read_into(technology);
  technology.path = path;
  if (technology.name.empty()) {
    throw InputError(fmt::format("{}: name: got none, expected that of the node", path));
  }
  std::set<std::string> stated;
  for (const ConfigOrigin& value : document.origins()) stated.insert(value.path);
  const Json table = parse_json(config_to_json(technology), path);
  check_stated(table, "", stated, path);
  check_sources(table, "", path);
  check_bands(table, "", path);
  const Json shipped = read_json(data_file("technology_32nm.json"));
  check_rows(technology, shipped);
  technology.note = note_on_published(read_json(path), shipped, path);
  return technology;
}

}  // namespace sgs

// Reading of technology tables.
#include "testbench/cost/technology.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "modules/config/strict_json.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// Throws InputError unless `stated` has each number of the table: what it lacks would cost nothing.
// Published points of the SRAM formula are in no cost. at: path of the keys.
void check_stated(const Json& table, const std::string& at, const std::set<std::string>& stated,
                  const std::string& path) {
  for (const auto& [key, value] : table.items()) {
    const std::string place = at.empty() ? key : at + "." + key;
    if (place == "sram.points" || key == "source") continue;
    if (value.is_object()) {
      check_stated(value, place, stated, path);
    } else if (!value.is_string() && stated.count(place) == 0) {
      throw InputError(fmt::format("{}: {}: got nothing, expected it", path, place));
    }
  }
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

const PartCost& Technology::part(const std::string& kind) const {
  const auto at = parts.find(kind);
  if (at != parts.end()) return at->second;
  throw InputError(fmt::format(
      "{}: parts: got no row \"{}\", expected one for all that a machine is made of", path, kind));
}

void visit(ConfigVisitor& v, PartCost& cost) {
  v.section("mm2", cost.mm2, "square millimetres of one");
  v.section("pj", cost.pj, "picojoules of one operation");
  v("source", cost.source, "where the numbers are from, and how sure they are");
}

void visit(ConfigVisitor& v, DieCost& cost) {
  v.section("clock_pj_mm2_cycle", cost.clock_pj_mm2_cycle,
            "picojoules of the clock tree for each square millimetre and cycle");
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
  v.sections("parts", technology.parts, "logic, by kind");
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
  check_bands(table, "", path);
  return technology;
}

}  // namespace sgs

// Reading of technology tables.
#include "testbench/cost/technology.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "modules/config/strict_json.h"

namespace sgs {
namespace {

template <class Row>
const Row& row_of(const Technology& technology, const std::map<std::string, Row>& rows,
                  const char* what, const std::string& kind) {
  const auto at = rows.find(kind);
  if (at != rows.end()) return at->second;
  throw InputError(
      fmt::format("technology {}: {} has no row \"{}\", expected one for all that a "
                  "machine is made of and does",
                  technology.name, what, kind));
}

}  // namespace

const OperationCost& Technology::operation(const std::string& kind) const {
  return row_of(*this, operations, "operations", kind);
}

const PartCost& Technology::part(const std::string& kind) const {
  return row_of(*this, parts, "parts", kind);
}

void visit(ConfigVisitor& v, OperationCost& cost) {
  v("pj", cost.pj, in_range(0, 1e9), "picojoules of one");
  v("source", cost.source, "where the number is from, and how sure it is");
}

void visit(ConfigVisitor& v, PartCost& cost) {
  v("mm2", cost.mm2, in_range(0, 1e6), "square millimetres of one");
  v("leakage_mw", cost.leakage_mw, in_range(0, 1e6), "milliwatts that one leaks");
  v("source", cost.source, "where the numbers are from, and how sure they are");
}

void visit(ConfigVisitor& v, Technology& technology) {
  v("name", technology.name, "of the node");
  v.sections("operations", technology.operations, "work, by kind");
  v.sections("parts", technology.parts, "what stands there, by kind");
}

Technology load_technology(const std::string& path) {
  ConfigDocument document;
  document.add_file(path);
  Technology technology;
  document.read_into(technology);
  return technology;
}

}  // namespace sgs

// What one operation costs in joules and one part in square millimetres: a table of data that a
// user can replace.
#pragma once

#include <map>
#include <string>

#include "modules/config/config_visitor.h"

namespace sgs {

struct OperationCost {
  double pj = 0;
  std::string source;
};

struct PartCost {
  double mm2 = 0;
  double leakage_mw = 0;
  std::string source;
};

struct Technology {
  std::string name;
  std::map<std::string, OperationCost> operations;  // by kind
  std::map<std::string, PartCost> parts;            // by kind

  // Throw InputError, naming the kind, where the table has no such row.
  const OperationCost& operation(const std::string& kind) const;
  const PartCost& part(const std::string& kind) const;
};

void visit(ConfigVisitor& v, OperationCost& cost);
void visit(ConfigVisitor& v, PartCost& cost);
void visit(ConfigVisitor& v, Technology& technology);

// Throws InputError.
Technology load_technology(const std::string& path);

}  // namespace sgs

// Results of a sweep as a table.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace sgs {

// One row a result, one column for each key that a point sets or that the model chose for one
// (with the value that was simulated), and for the numbers of a report that are compared first.
class SweepTable {
 public:
  // line: as sweep_record.h makes it.
  void add(const std::string& line);

  // Comma-separated, with a line of column names: paths as in report.json.
  std::string csv() const;

 private:
  using Row = std::map<std::string, std::string>;  // cell by column
  void add_keys(const std::vector<std::string>& keys);

  std::vector<std::string> keys_;  // keys of configurations, in the order in which they came
  std::vector<Row> rows_;
};

}  // namespace sgs

// Columns of groups.csv.
#include "testbench/streaminggs/report/group_table.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

std::string group_table(const ViewResult& view) {
  const std::vector<GoldenGroup>& groups = view.golden.groups;
  const std::vector<PartValues>& by_part = view.run.machine.by_part;
  if (groups.empty()) return "";
  std::string text = "group,x_px,y_px,width_px,height_px,blends,misordered,missed";
  for (const PartValues& column : by_part) text += "," + column.name;
  text += "\n";
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto& [pixels, blends, misordered, missed] = groups[g];
    text += fmt::format("{},{},{},{},{},{},{},{}", g, pixels.x0, pixels.y0, pixels.width(),
                        pixels.height(), blends, misordered, missed);
    // A unit that did nothing for the last groups may not have counted so far.
    for (const PartValues& column : by_part) {
      text += fmt::format(",{}", g < column.values.size() ? column.values[g] : std::uint64_t{0});
    }
    text += "\n";
  }
  return text;
}

}  // namespace sgs

// What a report says under a path, for example "dram.bytes" or "left_out[].what".
#pragma once

#include <string>

namespace sgs {

struct ReportEntry {
  std::string path, unit, meaning;
};

}  // namespace sgs

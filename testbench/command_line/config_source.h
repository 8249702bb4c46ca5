// --config and --set.
#pragma once

#include <string>
#include <vector>

#include "modules/config/strict_json.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

struct ConfigSource {
  std::string config;  // a preset or a file; empty: defaults alone
  std::vector<std::string> overrides;

  void add_to(CommandLine& line);

  // The file's name, empty without one. Throws InputError as config_file() does.
  std::string path() const;

  // The file with the overrides. Throws InputError.
  ConfigDocument document() const;
};

}  // namespace sgs

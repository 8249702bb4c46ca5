// --config, --set and --fit-memories.
#pragma once

#include <string>
#include <vector>

#include "modules/config/strict_json.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

struct ConfigSource {
  std::string config;  // a preset or a file; empty: defaults alone
  std::vector<std::string> overrides;
  bool fit_memories = false;  // on-chip memories become as large as all else needs

  // otherwise: what holds when --config is not given, as help says it.
  void add_to(CommandLine& line, const std::string& otherwise = "");
  // For commands that have a machine.
  void add_fitting_to(CommandLine& line);

  // The file's name, empty without one. Throws InputError as config_file() does.
  std::string path() const;

  bool is_preset() const;
  // A preset's name in messages, "preset exact"; empty for a file.
  std::string preset_in_words() const;

  // The preset's name, or the file's without folder and extension; empty without one.
  std::string name() const;

  // The same, and what goes over it: "exact + 2 settings, memories fitted".
  std::string in_words() const;

  // The file, over the preset that it names as its base, with the overrides. Throws InputError,
  // also when a preset's machine is set to another that has a preset of its own.
  ConfigDocument document() const;
};

}  // namespace sgs

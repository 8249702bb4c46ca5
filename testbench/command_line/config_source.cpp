// Options and reading of config_source.h.
#include "testbench/command_line/config_source.h"

#include <fmt/format.h>

#include "modules/config/join.h"
#include "testbench/command_line/presets.h"

namespace sgs {

void ConfigSource::add_to(CommandLine& line) {
  line.file("--config", config,
            fmt::format("JSON file or preset: {}", join(preset_names())).c_str());
  line.texts("--set", overrides, "key.path=value, over the configuration; may be repeated");
}

std::string ConfigSource::path() const { return config.empty() ? "" : config_file(config); }

ConfigDocument ConfigSource::document() const {
  ConfigDocument document;
  if (!config.empty()) document.add_file(path());
  for (const std::string& assignment : overrides) document.add_override(assignment);
  return document;
}

}  // namespace sgs

// Options and reading of config_source.h.
#include "testbench/command_line/config_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "algorithm/files/input_error.h"
#include "testbench/command_line/presets.h"

namespace sgs {

void ConfigSource::add_to(CommandLine& line, const std::string& otherwise) {
  line.file("--config", config,
            fmt::format("JSON file or preset: {}{}", join(preset_names()), otherwise).c_str());
  line.texts("--set", overrides, "key.path=value, over the configuration; may be repeated");
}

void ConfigSource::add_fitting_to(CommandLine& line) {
  line.flag("--fit-memories", fit_memories,
            "on-chip memories as large as all else needs; their sizes in the configuration still "
            "decide what it leaves open, such as groups and lists");
}

std::string ConfigSource::path() const { return config.empty() ? "" : config_file(config); }

bool ConfigSource::is_preset() const {
  const std::vector<std::string> presets = preset_names();
  return std::find(presets.begin(), presets.end(), config) != presets.end();
}

std::string ConfigSource::name() const { return std::filesystem::path(path()).stem().string(); }

std::string ConfigSource::in_words() const {
  std::string what = config.empty() ? "defaults" : name();
  if (!overrides.empty()) {
    what += fmt::format(" + {} setting{}", overrides.size(), overrides.size() == 1 ? "" : "s");
  }
  return fit_memories ? what + ", memories fitted" : what;
}

ConfigDocument ConfigSource::document() const {
  ConfigDocument document;
  if (is_preset()) {
    document.add_file(path(), preset_in_words());
  } else if (!config.empty()) {
    document.add_file(path());
  }
  const std::string machine = document.text_at("machine");
  for (const std::string& assignment : overrides) document.add_override(assignment);
  const std::string other = document.text_at("machine");
  if (is_preset() && other != machine && ConfigSource{other, {}}.is_preset()) {
    throw InputError(fmt::format("--set machine={}: preset {} is of machine {}, take --config {}",
                                 other, config, machine, other));
  }
  return document;
}

}  // namespace sgs

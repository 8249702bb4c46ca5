// Options and reading of config_source.h.
#include "testbench/command_line/config_source.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "algorithm/input_error.h"
#include "modules/config/join.h"
#include "testbench/command_line/option_checks.h"
#include "testbench/command_line/presets.h"

namespace sgs {

void ConfigSource::add_to(CLI::App& app) {
  app.add_option("--config", config, fmt::format("JSON file or preset: {}", join(preset_names())))
      ->check(not_empty())
      ->capture_default_str();
  app.add_option("--set", overrides, "key.path=value, over the configuration; may be repeated")
      ->allow_extra_args(false);  // what follows the value is another argument
}

std::string ConfigSource::path() const { return config.empty() ? "" : config_file(config); }

bool ConfigSource::is_preset() const {
  const std::vector<std::string> presets = preset_names();
  return std::find(presets.begin(), presets.end(), config) != presets.end();
}

std::string ConfigSource::name() const { return std::filesystem::path(path()).stem().string(); }

ConfigDocument ConfigSource::document() const {
  ConfigDocument document;
  if (!config.empty()) document.add_file(path());
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

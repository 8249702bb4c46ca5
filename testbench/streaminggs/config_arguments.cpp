// Presets, files and overrides.
#include "testbench/streaminggs/config_arguments.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "modules/config/strict_json.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

// A preset's name, or a file.
std::string config_path(const std::string& config) {
  const fs::path preset = fs::path(SGS_SOURCE_DIR) / "testbench" / "configs" / (config + ".json");
  if (config.find_first_of("./") == std::string::npos && fs::exists(preset)) return preset.string();
  return config;
}

}  // namespace

void ConfigArguments::add_config_to(CLI::App& app) {
  app.add_option("--config", config, "preset or JSON file")->capture_default_str();
  app.add_option("--set", overrides, "key.path=value, over the configuration");
}

AcceleratorConfig ConfigArguments::given_config() const {
  ConfigDocument document;
  document.add_file(config_path(config));
  for (const std::string& assignment : overrides) document.add_override(assignment);
  AcceleratorConfig given;
  document.read_into(given);
  return given;
}

void resolve(AcceleratorConfig& config, std::vector<AutoChoice>& chosen) {
  for (const AutoChoice& choice : resolve_auto(config)) chosen.push_back(choice);
  config.validate();
}

}  // namespace sgs

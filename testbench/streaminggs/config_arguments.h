// What all commands with a configuration have in common: --config and --set.
#pragma once

#include <string>
#include <vector>

#include "modules/accelerator_config.h"
#include "modules/auto_config.h"

namespace CLI {
class App;
}

namespace sgs {

struct ConfigArguments {
  std::string config = "exact";
  std::vector<std::string> overrides;

  void add_config_to(CLI::App& app);

  // As given; what is left to the model is not resolved yet. Throws InputError.
  AcceleratorConfig given_config() const;
};

// Makes it the resolved, valid configuration, and adds to `chosen` what was left to the model.
// Throws InputError.
void resolve(AcceleratorConfig& config, std::vector<AutoChoice>& chosen);

}  // namespace sgs

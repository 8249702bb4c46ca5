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

  // The resolved, valid configuration; chosen: what was left to the model. Throws InputError.
  AcceleratorConfig read_config(std::vector<AutoChoice>& chosen) const;
};

}  // namespace sgs

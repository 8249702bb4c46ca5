// Runs and checks.
#include "tests/system/shared_scenes.h"

#include <catch2/catch.hpp>

#include "tests/support/shared_inputs.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {

void check_shared_scene(const std::string& name, const std::string& preset,
                        const std::vector<Variant>& variants) {
  const std::string cameras = shared_path("cameras/" + name + ".json");
  const std::string scene = shared_scene(name);
  for (const Variant& variant : variants) {
    INFO(name << " " << preset << " " << (variant.empty() ? "plain" : variant.back()));
    std::vector<std::string> arguments = {scene, "--cameras", cameras, "--view",
                                          "all", "--config",  preset};
    arguments.insert(arguments.end(), variant.begin(), variant.end());
    Simulation(arguments).check();
  }
}

}  // namespace sgs::test

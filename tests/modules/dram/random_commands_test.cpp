// The checker finds nothing in what the channels do with random requests.
#include "tests/modules/dram/random_commands.h"

#include <catch2/catch.hpp>

namespace sgs {
namespace {

void check_all(std::uint64_t commands_each) {
  std::uint64_t commands = 0;
  for (std::uint32_t index = 0; index < test::kRandomConfigs; ++index) {
    const DramConfig config = test::random_config(index);
    config.validate();
    for (const auto run : {test::run_queued, test::run_arrival_order}) {
      const test::RandomRun result = run(config, commands_each, 1000 + index);
      INFO("config " << index);
      CHECK(result.violation == "");
      CHECK(result.served == result.pushed);
      commands += result.commands;
    }
  }
  CHECK(commands >= commands_each * 2 * test::kRandomConfigs);
}

TEST_CASE("random commands: ten million over all policies and memspecs are legal") {
  check_all(125000);
}

}  // namespace
}  // namespace sgs

// What the numbers of configurations may be: each key's range, stated and kept to.
#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "modules/machines.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/run/run_config.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

// A whole number's neighbour.
std::string next_to(const std::string& number, int away) {
  return number == "9223372036854775807" ? "9223372036854775808"
                                         : std::to_string(std::stoll(number) + away);
}

RunConfig preset_with(const std::string& preset, const std::vector<std::string>& overrides) {
  return read_run_config(ConfigSource{preset, overrides}.document(), machine_kinds());
}

struct Limits {
  std::string low, high;
};

// What the listing of keys says a machine's numbers may be, by key.
std::map<std::string, Limits> stated_limits(const std::string& preset) {
  RunConfig config = preset_with(preset, {});
  const std::unique_ptr<ConfigWriter> listing = make_listing_writer();
  visit(static_cast<ConfigVisitor&>(*listing), config);
  const std::regex line(R"(([a-z0-9_.]+) = \S*  \((-?[0-9.e+]+)\.\.([0-9.e+]+)\)  .*)");
  std::map<std::string, Limits> stated;
  std::istringstream lines(listing->text());
  for (std::string text; std::getline(lines, text);) {
    std::smatch parts;
    if (std::regex_match(text, parts, line)) stated[parts[1]] = {parts[2], parts[3]};
  }
  return stated;
}

// Which they are, the pages KEYS.md say: a test compares these with the program.
TEST_CASE("key limits: stated and kept to, of all keys of all machines") {
  constexpr std::size_t kFewestNumbers = 50;
  for (const char* preset : {"exact", "paper_no_vq", "gscore"}) {
    INFO(preset);
    const std::map<std::string, Limits> stated = stated_limits(preset);
    CHECK(stated.size() > kFewestNumbers);
    for (const auto& [key, limits] : stated) {
      INFO(key);
      for (const std::string& last : {limits.low, limits.high}) {
        CHECK_NOTHROW(preset_with(preset, {key + "=" + last}));
      }
      for (const std::string& beyond : {next_to(limits.low, -1), next_to(limits.high, 1)}) {
        const std::string refusal =
            input_error_of([&, key = key] { preset_with(preset, {key + "=" + beyond}); });
        CHECK_THAT(refusal, Contains("--set " + key + "=" + beyond + ": "));
        CHECK_THAT(refusal, Contains(key + ": got " + beyond + ", expected a") &&
                                Contains(" in [" + limits.low + ", " + limits.high + "]"));
      }
    }
  }
}

}  // namespace
}  // namespace sgs::test

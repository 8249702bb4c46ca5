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
  const std::regex line(R"(([a-z0-9_.]+) = \S*  \((-?[0-9.e+]+)\.\.([0-9.e+]+)(?:, null)?\)  .*)");
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

TEST_CASE("group of --set: both sides of a pixel group") {
  for (const auto& [shape, sides] : std::map<std::string, std::vector<std::string>>{
           {"64", {"group_width_px=64", "group_height_px=64"}},
           {"160x120", {"group_width_px=160", "group_height_px=120"}}}) {
    INFO(shape);
    const auto text_of = [](RunConfig config) {
      const std::unique_ptr<ConfigWriter> listing = make_listing_writer();
      visit(static_cast<ConfigVisitor&>(*listing), config);
      return listing->text();
    };
    CHECK(text_of(preset_with("exact", {"group=" + shape})) ==
          text_of(preset_with("exact", sides)));
  }
  for (const char* shape : {"", "x", "64x", "1x2x3", "-4", "big"}) {
    INFO(shape);
    CHECK_THROWS_WITH(preset_with("exact", {std::string("group=") + shape}),
                      Contains("--set group: got '" + std::string(shape) + "', expected px"));
  }
  CHECK_THROWS_WITH(preset_with("gscore", {"group=64"}), Contains("group_width_px"));
}

}  // namespace
}  // namespace sgs::test

// Parsing, and errors of CLI11 and SystemC as guard.h knows them.
#include "testbench/command_line/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <systemc>
#include <vector>

#include "algorithm/input_error.h"
#include "modules/config/join.h"
#include "testbench/command_line/version.h"

namespace sgs {
namespace {

// CLI11 says of a wrong command that none was given, and of none not which there are.
void check_command(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  const bool option = !word.empty() && word.front() == '-';
  if (names.empty() || option || std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError(fmt::format(
      "{}, expected one of {}",
      argc > 1 ? fmt::format("'{}': no such command", word) : std::string("got no command"),
      join(names)));
}

}  // namespace

int run_program(CLI::App& app, int argc, const char* const* argv,
                const std::function<int()>& body) {
  app.set_version_flag("--version", fmt::format("{} {}", app.get_name(), version_text()));
  return run_guarded(app.get_name(), [&] {
    check_command(app, argc, argv);
    try {
      app.parse(argc, argv);
      return body();
    } catch (const CLI::Success& asked_for_help) {
      return app.exit(asked_for_help);
    } catch (const CLI::ParseError& error) {
      throw InputError(
          fmt::format("{} ({} --help lists what there is)", error.what(), app.get_name()));
    } catch (const sc_core::sc_report& report) {
      throw std::runtime_error(fmt::format("{}: {}", report.get_msg_type(), report.get_msg()));
    }
  });
}

}  // namespace sgs

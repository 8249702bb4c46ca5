// Parsing, and errors of CLI11 and SystemC as guard.h knows them.
#include "testbench/command_line/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <systemc>

#include "algorithm/input_error.h"
#include "testbench/command_line/version.h"

namespace sgs {

int run_program(CLI::App& app, int argc, const char* const* argv,
                const std::function<int()>& body) {
  app.set_version_flag("--version", fmt::format("{} {}", app.get_name(), version_text()));
  return run_guarded(app.get_name(), [&] {
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

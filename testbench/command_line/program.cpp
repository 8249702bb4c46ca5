// Errors of SystemC as guard.h knows them.
#include "testbench/command_line/program.h"

#include <fmt/format.h>

#include <stdexcept>
#include <systemc>

#include "algorithm/files/data_files.h"

namespace sgs {

int run_program(CommandLine& line, int argc, const char* const* argv,
                const std::function<int()>& body) {
  return run_guarded(line.name(), [&] {
    try {
      if (!line.parse(argc, argv)) return kDone;
      require_data_files();
      return body();
    } catch (const sc_core::sc_report& report) {
      throw std::runtime_error(fmt::format("{}: {}", report.get_msg_type(), report.get_msg()));
    }
  });
}

}  // namespace sgs

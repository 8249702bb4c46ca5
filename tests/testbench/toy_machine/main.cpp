// streaminggs_toy: the command, with one machine more.
#include <systemc>

#include "modules/machines.h"
#include "testbench/streaminggs/commands.h"
#include "tests/testbench/toy_machine/toy_design.h"
#include "tlm/no_banner.h"

int sc_main(int argc, char* argv[]) {
  std::vector<sgs::MachineKind> kinds = sgs::machine_kinds();
  kinds.push_back({"toy", "one colour a group", []() -> std::unique_ptr<sgs::MachineDesign> {
                     return std::make_unique<sgs::toy::ToyDesign>();
                   }});
  return sgs::run_command_line(argc, argv, kinds, sgs::all_commands());
}

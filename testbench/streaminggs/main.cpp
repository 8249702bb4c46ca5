// streaminggs: simulates scenes, and starts streaminggs-commands for whatever else is asked of it:
// a first picture needs no more of the sources than a simulation does.
#include <systemc>

#include "modules/machines.h"
#include "testbench/streaminggs/commands.h"
#include "tlm/no_banner.h"

int sc_main(int argc, char* argv[]) {
  return sgs::run_command_line(argc, argv, sgs::machine_kinds(),
                               {{"simulate", sgs::add_simulate_command}});
}

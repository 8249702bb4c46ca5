// streaminggs-commands: all of streaminggs, which also packs, renders, compares, explores, trains.
#include <systemc>

#include "modules/machines.h"
#include "testbench/streaminggs/commands.h"
#include "tlm/no_banner.h"

int sc_main(int argc, char* argv[]) {
  return sgs::run_command_line(argc, argv, sgs::machine_kinds(), sgs::all_commands());
}

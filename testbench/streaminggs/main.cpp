// streaminggs: packs, renders, simulates, compares and describes scenes.
#include <systemc>

#include "modules/machines.h"
#include "testbench/streaminggs/commands.h"
#include "tlm/no_banner.h"

int sc_main(int argc, char* argv[]) {
  return sgs::run_command_line(argc, argv, sgs::machine_kinds());
}

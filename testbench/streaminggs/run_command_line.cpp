// The command line of streaminggs, for whatever machines there are.
#include <utility>
#include <vector>

#include "testbench/command_line/program.h"
#include "testbench/command_line/while_doing.h"
#include "testbench/streaminggs/commands.h"

namespace sgs {

int run_command_line(int argc, char* argv[], const Kinds& kinds) {
  CommandLine line("streaminggs",
                   "StreamingGS: a memory-centric 3D Gaussian Splatting accelerator in SystemC "
                   "TLM-2.0");
  std::vector<std::pair<const CommandLine*, SubCommand>> commands;
  const auto add = [&](const char* name, const char* what,
                       SubCommand (*make)(CommandLine&, const Kinds&)) {
    CommandLine& command = line.command(name, what);
    commands.emplace_back(&command, make(command, kinds));
  };
  add("simulate", "send a scene through the accelerator", add_simulate_command);
  add("what-if", "double each resource in turn: what it gains and costs", add_what_if_command);
  add("sweep", "simulate many configurations, scenes and views side by side", add_sweep_command);
  add("diff", "what differs between two runs, and by how much", add_diff_command);
  add("pack", "write the memory image of a scene into a file", add_pack_command);
  add("train", "make a scene from photographs", add_train_command);
  add("tune", "fit a scene that stands to the order or the codebooks of a machine",
      add_tune_command);
  add("render", "write one golden image", add_render_command);
  add("compare", "PSNR, SSIM and largest error of two images", add_compare_command);
  add("photographs", "write the test views of a data set as files", add_photographs_command);
  add("gpu", "model the original rasteriser on a mobile GPU", add_gpu_command);
  add("info", "print what a scene holds", add_info_command);
  add("describe", "print the data sheets and the configuration of a machine", add_describe_command);
  return run_program(line, argc, argv, [&] {
    for (const auto& [command, run] : commands) {
      if (command->chosen()) return while_doing("running " + command->name(), run);
    }
    return kBadInput;
  });
}

}  // namespace sgs

// The commands of `streaminggs`; each adds itself to the command line and returns what runs it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "modules/machine_design.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

// Exit status: 0 done, 1 the run failed or a check did not hold. Bad input throws InputError.
using SubCommand = std::function<int()>;

// kinds: the machines that there are, which outlive the command.
using Kinds = std::vector<MachineKind>;

SubCommand add_render_command(CommandLine& line, const Kinds& kinds);
SubCommand add_simulate_command(CommandLine& line, const Kinds& kinds);
SubCommand add_what_if_command(CommandLine& line, const Kinds& kinds);
SubCommand add_sweep_command(CommandLine& line, const Kinds& kinds);
SubCommand add_compare_command(CommandLine& line, const Kinds& kinds);
SubCommand add_diff_command(CommandLine& line, const Kinds& kinds);
SubCommand add_pack_command(CommandLine& line, const Kinds& kinds);
SubCommand add_train_command(CommandLine& line, const Kinds& kinds);
SubCommand add_tune_command(CommandLine& line, const Kinds& kinds);
SubCommand add_photographs_command(CommandLine& line, const Kinds& kinds);
SubCommand add_gpu_command(CommandLine& line, const Kinds& kinds);
SubCommand add_convert_command(CommandLine& line, const Kinds& kinds);
SubCommand add_info_command(CommandLine& line, const Kinds& kinds);
SubCommand add_describe_command(CommandLine& line, const Kinds& kinds);

// The functions that add commands, by the command's name.
using Commands = std::map<std::string, SubCommand (*)(CommandLine& line, const Kinds& kinds)>;
Commands all_commands();

// The command line of `streaminggs` in a program that has these commands; streaminggs-commands, a
// program beside it, takes the place of this one for any other. Parses the arguments, runs the
// command, prints errors. Exit status: as above, 2 for bad arguments or input.
int run_command_line(int argc, char* argv[], const Kinds& kinds, const Commands& commands);

}  // namespace sgs

// Every command, for programs that have them all.
#include "testbench/streaminggs/commands.h"

namespace sgs {

Commands all_commands() {
  return {{"simulate", add_simulate_command}, {"what-if", add_what_if_command},
          {"sweep", add_sweep_command},       {"diff", add_diff_command},
          {"pack", add_pack_command},         {"train", add_train_command},
          {"tune", add_tune_command},         {"render", add_render_command},
          {"compare", add_compare_command},   {"photographs", add_photographs_command},
          {"gpu", add_gpu_command},           {"convert", add_convert_command},
          {"info", add_info_command},         {"describe", add_describe_command}};
}

}  // namespace sgs

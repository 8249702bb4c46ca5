// The commands of `streaminggs`; each adds itself to the command line and returns what runs it.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sgs {

// Exit status: 0 done, 1 the run failed or a check did not hold. Bad input throws InputError.
using SubCommand = std::function<int()>;

SubCommand add_render_command(CLI::App& app);
SubCommand add_simulate_command(CLI::App& app);
SubCommand add_compare_command(CLI::App& app);
SubCommand add_pack_command(CLI::App& app);
SubCommand add_info_command(CLI::App& app);

}  // namespace sgs

// streaminggs: packs, renders, simulates, compares and describes scenes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <systemc>
#include <utility>
#include <vector>

#include "algorithm/input_error.h"
#include "testbench/streaminggs/commands.h"
#include "tlm/no_banner.h"

int sc_main(int argc, char* argv[]) {
  constexpr int kBadInput = 2;
  CLI::App app{
      "StreamingGS: a memory-centric 3D Gaussian Splatting accelerator in SystemC TLM-2.0"};
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, sgs::SubCommand>> commands;
  const auto add = [&](const char* name, const char* what, sgs::SubCommand (*make)(CLI::App&)) {
    CLI::App* command = app.add_subcommand(name, what);
    commands.emplace_back(command, make(*command));
  };
  add("simulate", "send a scene through the accelerator", sgs::add_simulate_command);
  add("pack", "write the memory image of a scene into a file", sgs::add_pack_command);
  add("render", "write one golden image", sgs::add_render_command);
  add("compare", "PSNR, SSIM and largest error of two images", sgs::add_compare_command);
  add("info", "print what a scene holds", sgs::add_info_command);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  try {
    for (const auto& [command, run] : commands) {
      if (command->parsed()) return run();
    }
  } catch (const sgs::InputError& error) {
    std::fprintf(stderr, "streaminggs: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "streaminggs: %s\n", error.what());
    return 1;
  }
  return 1;
}

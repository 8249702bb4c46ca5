// The command line of streaminggs, for whatever machines there are.
#include <fmt/format.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
#include "testbench/command_line/guard.h"
#include "testbench/command_line/program.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {
namespace {

struct Help {
  const char* command;
  const char* purpose;
  const char* example;  // its arguments
  const char* failed = "1 it failed";
  const char* done = "0 done";
};

constexpr const char* kFrameFailed =
    "1 a simulation failed, or a frame differs from the streaming renderer's";

constexpr Help kHelp[] = {
    {"simulate", "send a scene through the accelerator",
     "scene.ply --cameras cameras.json --config exact --out out/scene", kFrameFailed},
    {"what-if", "double each resource in turn: what it gains and costs",
     "scene.ply --cameras cameras.json --config exact", kFrameFailed},
    {"sweep", "simulate many configurations, scenes and views side by side",
     "scene.ply --cameras cameras.json --axis hfus=2,4,8 --out sweep.jsonl",
     "1 a simulation failed; 130 interrupted, the same command continues"},
    {"diff", "what differs between two runs, and by how much", "out/a out/b", "1 it failed",
     "0 done, whether they differ or not"},
    {"pack", "write the memory image of a scene into a file",
     "scene.ply --cameras cameras.json --config exact_vq --out scene.sgs"},
    {"train", "make a scene from photographs", "photographs/garden --out garden.ply",
     "1 it failed; 130 interrupted, --resume continues"},
    {"tune", "fit a scene that stands to the order or the codebooks of a machine",
     "scene.ply --cameras cameras.json --boundary --out tuned.ply",
     "1 it failed; 130 interrupted, --resume continues"},
    {"render", "write one golden image", "scene.ply --cameras cameras.json --out view.png"},
    {"compare", "PSNR, SSIM and largest error of two images", "a.exr b.exr --exact",
     "1 it failed, or with --exact they differ"},
    {"photographs", "write the test views of a data set as files",
     "photographs/garden --out views"},
    {"gpu", "model the original rasteriser on a mobile GPU",
     "scene.ply --cameras cameras.json --set watts=5"},
    {"convert", "write a scene of any form as an INRIA .ply", "scene.spz --out scene.ply"},
    {"info", "print what a scene holds", "scene.ply"},
    {"describe", "print the data sheets and the configuration of a machine", "--config paper"},
};

std::string end_of_help(const Help& help) {
  return fmt::format(
      "Example:\n  streaminggs {} {}\n\nExit status: {}; {}; 2 bad arguments or input",
      help.command, help.example, help.done, help.failed);
}

// The first word that is no option of the program itself, none of which has a value; else empty.
std::string_view command_word(int argc, char* argv[]) {
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] != '-') return argv[i];
  }
  return {};
}

bool is_elsewhere(std::string_view word, const Commands& commands) {
  for (const Help& help : kHelp) {
    if (word == help.command) return commands.count(help.command) == 0;
  }
  return false;
}

// The process, its streams and its arguments become those of the other program. Throws where there
// is none.
int hand_over(std::string_view word, int argc, char* argv[]) {
  constexpr const char* kOther = "streaminggs-commands";
  const auto other = std::filesystem::read_symlink("/proc/self/exe").parent_path() / kOther;
  std::vector<char*> words(argv, argv + argc);
  words.push_back(nullptr);
  ::execv(other.c_str(), words.data());
  throw InputError(fmt::format(
      "{}: is done by {} ({}), expected it beside this program: scripts/setup.sh release {}", word,
      other.string(), std::strerror(errno), kOther));
}

}  // namespace

int run_command_line(int argc, char* argv[], const Kinds& kinds, const Commands& commands) {
  CommandLine line("streaminggs",
                   "StreamingGS: a memory-centric 3D Gaussian Splatting accelerator in SystemC "
                   "TLM-2.0");
  const std::string_view word = command_word(argc, argv);
  if (is_elsewhere(word, commands)) {
    return run_guarded(line.name(), [&] { return hand_over(word, argc, argv); });
  }
  std::vector<std::pair<const CommandLine*, SubCommand>> here;
  for (const Help& help : kHelp) {
    CommandLine& command = line.command(help.command, help.purpose);
    command.end_help_with(end_of_help(help));
    command.set_keys([&kinds] { return keys_of(kinds); });
    const auto found = commands.find(help.command);
    if (found != commands.end()) here.emplace_back(&command, found->second(command, kinds));
  }
  return run_program(line, argc, argv, [&] {
    for (const auto& [command, run] : here) {
      if (command->chosen()) return while_doing("running " + command->name(), run);
    }
    return kBadInput;
  });
}

}  // namespace sgs

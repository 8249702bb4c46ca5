// Command traces: written, read back, refused when they are not what they say.
#include "modules/dram/command_trace.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <vector>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

std::string fresh_path(const char* name) {
  return std::string(SGS_BINARY_DIR) + "/" + name + "_" + std::to_string(getpid());
}

struct File {
  explicit File(const std::string& text) : path(fresh_path("trace")) {
    std::ofstream(path) << text;
  }
  ~File() { fs::remove(path); }
  std::string refusal() const {
    try {
      CommandTraceReader reader(path);
      CommandRecord record;
      while (reader.next(record)) continue;
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path.size());
    }
    return "accepted";
  }
  const std::string path;
};

// Hands on a list when it is asked to catch up.
struct ListedCommands : CommandSource {
  std::vector<CommandRecord> waiting;
  CommandSink* sink = nullptr;

  void add_command_sink(CommandSink& added) override { sink = &added; }
  void remove_command_sink(CommandSink&) override { sink = nullptr; }
  void catch_up() override {
    for (const CommandRecord& record : waiting) sink->on_command(record);
  }
};

const std::string kHeader =
    "# streaminggs dram command trace, version 2\n# memspec lpddr3_1600_4gb\n# channels 2\n"
    "# ranks 1\n# write_latency_set a\n# refresh all_bank\n";

TEST_CASE("command trace: what is written reads back") {
  const std::string path = fresh_path("written");
  DramConfig config;
  config.channels = 2;
  config.write_latency_set = WriteLatencySet::kB;
  config.refresh = RefreshMode::kPerBank;
  const std::vector<CommandRecord> records = {
      {5, Command::kActivate, 1, 0, 3, 9, 16383, 0},
      {20, Command::kWriteAuto, 1, 0, 3, 9, 0, 127},
      {std::uint64_t{1} << 40, Command::kRefreshBank, 0, 0, 7, 0, 0, 0}};
  ListedCommands source;
  OutputFile file(path);
  CommandTraceWriter writer(file, CommandTraceHeader::of(config), source);
  source.waiting = records;
  writer.close();
  CHECK(source.sink == nullptr);
  file.commit();

  CommandTraceReader reader(path);
  CHECK(reader.header().memspec == "lpddr3_1600_4gb");
  CHECK(reader.header().channels == 2);
  CHECK(reader.header().write_latency_set == WriteLatencySet::kB);
  CHECK(reader.header().refresh == RefreshMode::kPerBank);
  for (const CommandRecord& expected : records) {
    CommandRecord r;
    REQUIRE(reader.next(r));
    CHECK(r.cycle == expected.cycle);
    CHECK(r.command == expected.command);
    CHECK(r.channel == expected.channel);
    CHECK(r.bank == expected.bank);
    CHECK(r.row == expected.row);
    CHECK(r.burst == expected.burst);
  }
  CommandRecord none;
  CHECK_FALSE(reader.next(none));
  fs::remove(path);
}

TEST_CASE("command trace: bad files are refused with line, found and expected") {
  const std::string one = kHeader + "0 0 ACT 0 3 17\n";
  CHECK(File(one + "# commands 1\n").refusal() == "accepted");
  CHECK(File(kHeader + "# commands 0\n").refusal() == "accepted");
  CHECK(File(kHeader + "0 255 ACT 255 255 4294967295\n# commands 1\n").refusal() == "accepted");
  struct Row {
    const char *end, *refusal;
  };
  for (const auto& [end, refusal] :
       {Row{"", ": line 8: got 'the end of the file', expected a command or '# commands 1'"},
        Row{"# commands 2\n", ": line 8: got '# commands 2', expected '# commands 1'"},
        Row{"# commands 1\n0 0 ACT 0 3 17\n",
            ": line 9: got '0 0 ACT 0 3 17', expected nothing behind '# commands 1'"}}) {
    CHECK(File(one + end).refusal().find(refusal) == 0);
  }
  CHECK(File("").refusal().find(": line 1: got ''") == 0);
  CHECK(File("hello\n").refusal().find(": line 1: got 'hello'") == 0);
  CHECK(File(kHeader.substr(0, 60)).refusal().find(": line 3: got ''") == 0);
  for (const char* line :
       {"0 0 ACT 0 3", "0 0 ACT 0 3 17 9", "0 0 FLY 0 3 17", "-1 0 ACT 0 3 17", "x 0 ACT 0 3 17",
        "0 256 ACT 0 3 17", "0 0 ACT 256 3 17", "0 0 ACT 0 256 17", "0 0 ACT 0 3 4294967296", ""})
    CHECK(File(one + line + "\n")
              .refusal()
              .find(": line 8: got '" + std::string(line) + "', expected cycle channel") == 0);
  CHECK_THROWS_AS(CommandTraceReader("/nowhere/trace"), InputError);
}

}  // namespace
}  // namespace sgs

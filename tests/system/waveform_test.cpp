// The waveform holds every signal that the saved view opens and none that it leaves out, and its
// values are those of the report.
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

const std::string kMachine = "SystemC.accelerator.";

// Signals of a VCD file by name, with their short code.
std::map<std::string, std::string> signals_of(const std::string& vcd_path) {
  std::map<std::string, std::string> signals;
  std::vector<std::string> scopes;
  std::ifstream file(vcd_path);
  for (std::string line; std::getline(file, line) && line.rfind("$enddefinitions", 0) != 0;) {
    std::istringstream words(line);
    std::string what, kind, width, code, name, range;
    words >> what;
    if (what == "$scope") {
      words >> kind >> name;
      scopes.push_back(name);
    } else if (what == "$upscope") {
      scopes.pop_back();
    } else if (what == "$var") {
      words >> kind >> width >> code >> name >> range;
      std::string path;
      for (const std::string& scope : scopes) path += scope + ".";
      signals[path + name + (range == "$end" ? "" : range)] = code;
    }
  }
  return signals;
}

// Signals of a GTKWave save file by the name that they are shown under: "+{shown as} signal".
std::map<std::string, std::string> signals_in_view(const std::string& gtkw_path) {
  std::map<std::string, std::string> signals;
  std::ifstream file(gtkw_path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t end = line.find("} ");
    if (line.rfind("+{", 0) != 0 || end == std::string::npos) continue;
    const std::string shown_as = line.substr(2, end - 2);
    INFO(shown_as);
    CHECK(signals.count(shown_as) == 0);             // no two look alike
    CHECK(shown_as.find('.') == std::string::npos);  // GTKWave shows what is behind the last dot
    signals[shown_as] = line.substr(end + 2);
  }
  return signals;
}

// Time during which a signal has each of its values, in the file's unit, up to its last time.
std::map<std::uint64_t, std::uint64_t> time_at(const std::string& vcd_path,
                                               const std::string& code) {
  std::ifstream file(vcd_path);
  std::uint64_t now = 0, since = 0, value = 0;
  std::map<std::uint64_t, std::uint64_t> times;
  for (std::string line; std::getline(file, line);) {
    const std::size_t blank = line.find(' ');
    std::string bits;  // "1code" or "b101 code"
    if (line[0] == '#') now = std::stoull(line.substr(1));
    if ((line[0] == '0' || line[0] == '1') && line.substr(1) == code) bits = line.substr(0, 1);
    if (line[0] == 'b' && line.substr(blank + 1) == code) bits = line.substr(1, blank - 1);
    if (bits.empty()) continue;
    times[value] += now - since;
    value = std::stoull(bits, nullptr, 2);
    since = now;
  }
  times[value] += now - since;
  return times;
}

// The time at one value is that of so many cycles of 1 ns. The memory may end the frame between two
// edges of the units' clock.
void check_time(std::map<std::uint64_t, std::uint64_t> times, std::uint64_t value,
                std::uint64_t cycles) {
  constexpr std::uint64_t kCycle = 1000;  // time unit 1 ps, 1 GHz
  CHECK(times[value] >= kCycle * cycles);
  CHECK(times[value] < kCycle * (cycles + 1));
}

// What an activity shows is what the report says of it.
void check_activity(const std::string& vcd, const std::map<std::string, std::string>& signals,
                    const std::string& path, const nlohmann::json& spent) {
  INFO(path);
  REQUIRE(signals.count(path + ".busy") == 1);
  check_time(time_at(vcd, signals.at(path + ".busy")), 1, spent["busy_cycles"]);
  const auto waiting = time_at(vcd, signals.at(path + ".waits_for[2:0]"));
  // As traces/README.md has them, from 1.
  const char* const kNames[] = {"input", "reads", "writes", "room", "port", "loading", "phase"};
  std::uint64_t value = 0;
  for (const char* name : kNames) {
    INFO(name);
    check_time(waiting, ++value, spent["waited_cycles"][name]);
  }
}

struct Shown {
  const char* machine;
  const char* view;                 // in traces/
  std::vector<std::string> moving;  // signals that change often
};

void check_waveform(const Shown& shown) {
  const std::string machine = shown.machine;
  const ScratchFolder scratch;
  const std::string vcd = scratch.path("wave.vcd");
  const Simulation run(
      {"builtin:object?n=1000", "--size", "48x27", "--config", machine, "--vcd", vcd});
  check_any_machine(run.views()[0]);
  const auto signals = signals_of(vcd);
  CHECK(signals.size() > 50);
  const auto view = signals_in_view(std::string(SGS_SOURCE_DIR) + "/traces/" + shown.view);
  std::set<std::string> in_view, in_file;
  for (const auto& [shown_as, signal] : view) in_view.insert(signal);
  for (const auto& [signal, code] : signals) in_file.insert(signal);
  CHECK(in_view == in_file);
  for (const auto& [name, unit] : run.views()[0]["units"].items()) {
    for (const auto& [activity, spent] : unit["activities"].items()) {
      check_activity(vcd, signals, kMachine + name + "." + activity, spent);
    }
  }
  const std::string text = bytes_of(vcd);
  // The last moment is there: bursts of the last write are counted in it.
  std::uint64_t row_hits = 0;
  for (const auto& [signal, code] : signals) {
    if (signal.find(".row_hits[") == std::string::npos) continue;
    const std::size_t at = text.rfind(" " + code + "\n");
    REQUIRE(at != std::string::npos);
    const std::size_t digits = text.rfind('\n', at) + 2;  // "b1011 code"
    row_hits += std::stoull(text.substr(digits, at - digits), nullptr, 2);
  }
  CHECK(row_hits == run.views()[0]["dram"]["row_hits"]);
  // Bytes were on their way, FIFOs filled, rows were hit.
  for (const std::string& name : shown.moving) {
    const std::string code = signals.at("SystemC." + name);
    INFO(name);
    std::size_t changes = 0;
    for (std::size_t at = text.find(" " + code + "\n"); at != std::string::npos;
         at = text.find(" " + code + "\n", at + 1)) {
      ++changes;
    }
    CHECK(changes > 20);
  }
  CHECK(text.size() < 4'000'000);  // a picture to look at, not a dump
}

TEST_CASE("waveform: every machine, in its saved view") {
  const std::vector<std::string> streaming = {
      "accelerator.hfu0.coarse.memory.bytes_outstanding[63:0]",
      "accelerator.visits_to_hfu0.fill[31:0]", "dram.channel0.row_hits[63:0]"};
  for (const Shown& shown :
       {Shown{"exact", "accelerator.gtkw", streaming},
        Shown{"paper", "accelerator_paper.gtkw", streaming},
        Shown{"gscore",
              "accelerator_gscore.gtkw",
              {"accelerator.ccu0.second_memory.bytes_outstanding[63:0]",
               "accelerator.sorted_of_core0.fill[31:0]", "dram.channel0.row_hits[63:0]"}}}) {
    INFO(shown.machine);
    check_waveform(shown);
  }
}

TEST_CASE("waveform: quantised scenes show the codebook buffer and what decodes") {
  for (const char* machine : {"exact", "paper"}) {
    const ScratchFolder scratch;
    const std::string vcd = scratch.path("wave.vcd");
    const Arguments scene = {
        "builtin:object?n=1000",      "--size", "48x27", "--config", machine, "--set",
        "sram.codebook_bytes=256000", "--vcd",  vcd};
    const Simulation run(joined(scene, {"--set", "storage.encoding=vq_packed", "--weigh-by", "0"}));
    run.check();
    const auto signals = signals_of(vcd);
    const Json& view = run.views()[0];
    check_activity(vcd, signals, kMachine + "codebooks.load",
                   view["units"]["codebooks"]["activities"]["load"]);
    for (const std::string unit : {"hfu0.fine", "hfu1.fine"}) {
      check_activity(vcd, signals, kMachine + unit + ".decode",
                     view["units"][unit]["activities"]["decode"]);
    }
    for (const std::string hfu : {"hfu0", "hfu1"}) {
      CHECK(signals.count(kMachine + hfu + ".fine.decoded.fill[31:0]") == 1);
    }
    check_time(time_at(vcd, signals.at(kMachine + "codebooks.full")), 1,
               frame_cycles(view) - total(view, "loaded_at_cycle"));
    // What is not there is not shown.
    const Simulation raw(with_settings(scene, {"storage.encoding=raw"}));
    const auto without = signals_of(vcd);
    CHECK(without.count(kMachine + "hfu0.fine.filter.busy") == 1);
    CHECK(without.count(kMachine + "hfu0.fine.decode.busy") == 0);
    CHECK(without.count(kMachine + "codebooks.full") == 0);
  }
}

// SystemC warns at each moment between two units of the file.
TEST_CASE("waveform: its unit holds every moment, of odd clocks and of a display's rows too") {
  const Arguments stream = {"--path", "builtin:path", "--frames", "2", "--stream"};
  struct Row {
    Arguments arguments;
    const char* unit;
  };
  for (const auto& [arguments, unit] :
       {Row{{"--view", "0"}, "1 ps"}, Row{settings({"clock_mhz=700"}), "1 fs"},
        Row{settings({"dram.memspec=lpddr3_2133_4gb"}), "1 fs"},
        Row{joined(stream, {"--frame-rate", "0"}), "1 ps"},
        Row{joined(stream, {"--frame-rate", "9000"}), "1 fs"}}) {
    INFO(arguments.back());
    const ScratchFolder scratch;
    const std::string vcd = scratch.path("wave.vcd");
    const Outcome outcome =
        run_streaminggs(joined({"simulate", "builtin:object?n=1000", "--size", "48x27", "--vcd",
                                vcd, "--out", scratch.path("out")},
                               arguments));
    INFO(outcome.out << outcome.err);
    CHECK(outcome.status == 0);
    CHECK((outcome.out + outcome.err).find("Warning") == std::string::npos);
    CHECK(bytes_of(vcd).find(std::string("$timescale\n     ") + unit + "\n$end") !=
          std::string::npos);
  }
}

}  // namespace
}  // namespace sgs::test

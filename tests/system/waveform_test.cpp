// The waveform holds every signal that the saved view opens, and its values are those of the
// report.
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

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

// Signal lines of a GTKWave save file: those that are no format, comment, group or setting.
std::set<std::string> signals_in_view(const std::string& gtkw_path) {
  std::set<std::string> names;
  std::ifstream file(gtkw_path);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && std::string("@-[*#").find(line[0]) == std::string::npos)
      names.insert(line);
  }
  return names;
}

// Time during which a one-bit signal is 1, in the file's unit, up to its last time.
std::uint64_t time_high(const std::string& vcd_path, const std::string& code) {
  std::ifstream file(vcd_path);
  std::uint64_t now = 0, since = 0, sum = 0;
  bool high = false;
  for (std::string line; std::getline(file, line);) {
    if (line[0] == '#') {
      now = std::stoull(line.substr(1));
    } else if (line.size() > 1 && (line[0] == '0' || line[0] == '1') && line.substr(1) == code) {
      if (high) sum += now - since;
      high = line[0] == '1';
      since = now;
    }
  }
  return sum + (high ? now - since : 0);
}

void check_waveform(const std::string& order, const std::string& timing) {
  const ScratchFolder scratch;
  const std::string vcd = scratch.path("wave.vcd");
  const Simulation run({"builtin:object?n=1000", "--size", "48x27", "--config", order, "--timing",
                        timing, "--vcd", vcd});
  run.check();
  const auto signals = signals_of(vcd);
  const auto shown =
      signals_in_view(std::string(SGS_SOURCE_DIR) + "/traces/" +
                      (order == "paper" ? "accelerator_paper.gtkw" : "accelerator.gtkw"));
  CHECK(shown.size() > 100);
  for (const std::string& name : shown) {
    INFO(name);
    CHECK(signals.count(name) == 1);
  }
  // Time unit 1 ps, 1 GHz.
  constexpr std::uint64_t kCycle = 1000;
  for (const char* unit : {"rendering.blend", "hfu2.fine", "hfu0.coarse"}) {
    const auto code = signals.at("SystemC.accelerator." + std::string(unit) + ".busy");
    CHECK(time_high(vcd, code) ==
          kCycle * run.views()[0]["units"][unit]["busy_cycles"].get<std::uint64_t>());
  }
  // Bytes were on their way, rows were hit.
  const std::string text = bytes_of(vcd);
  for (const char* name : {"hfu0_port.bytes_outstanding[63:0]", "dram.channel0.row_hits[63:0]"}) {
    const std::string code = signals.at("SystemC.accelerator." + std::string(name));
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

TEST_CASE("waveform: exact order") { check_waveform("exact", "accurate"); }
TEST_CASE("waveform: paper order") { check_waveform("paper", "accurate"); }
TEST_CASE("waveform: fast timing") { check_waveform("paper", "fast"); }

TEST_CASE("waveform: quantised scenes show the codebook buffer and what decodes") {
  for (const char* order : {"exact", "paper"}) {
    const ScratchFolder scratch;
    const std::string vcd = scratch.path("wave.vcd");
    const std::vector<std::string> scene = {
        "builtin:object?n=1000",      "--size", "48x27", "--config", order, "--set",
        "sram.codebook_bytes=256000", "--vcd",  vcd};
    std::vector<std::string> quantised = scene;
    quantised.insert(quantised.end(), {"--set", "encoding=vq_packed", "--weigh-by", "0"});
    const Simulation run(quantised);
    run.check();
    const auto signals = signals_of(vcd);
    const std::string prefix = "SystemC.accelerator.";
    // The memory may end the frame between two edges of the units' clock.
    const auto check_time = [&](const std::string& signal, std::uint64_t cycles) {
      constexpr std::uint64_t kCycle = 1000;
      const std::uint64_t high = time_high(vcd, signals.at(signal));
      CHECK(high >= kCycle * cycles);
      CHECK(high < kCycle * (cycles + 1));
    };
    for (const char* unit : {"codebooks.load", "hfu0.decode", "hfu3.decode"}) {
      for (const char* state : {".busy", ".starved", ".blocked"}) {
        INFO(unit << state);
        REQUIRE(signals.count(prefix + unit + state) == 1);
        check_time(prefix + unit + state,
                   run.views()[0]["units"][unit][std::string(state).substr(1) + "_cycles"]);
      }
    }
    CHECK(signals.count(prefix + "hfu1.decoded.fill[31:0]") == 1);
    REQUIRE(signals.count(prefix + "codebooks.full") == 1);
    check_time(prefix + "codebooks.full", run.views()[0]["frame"]["cycles"].get<std::uint64_t>() -
                                              total(run.views()[0], "loaded_at_cycle"));
    // What is not there is not shown.
    std::vector<std::string> raw_scene = scene;
    raw_scene.insert(raw_scene.end(), {"--set", "encoding=raw"});
    const Simulation raw(raw_scene);
    const auto without = signals_of(vcd);
    CHECK(without.count(prefix + "hfu0.fine.busy") == 1);
    CHECK(without.count(prefix + "hfu0.decode.busy") == 0);
    CHECK(without.count(prefix + "codebooks.full") == 0);
  }
}

TEST_CASE("waveform: tracing changes nothing") {
  const ScratchFolder scratch;
  for (const char* timing : {"accurate", "fast"}) {
    const std::vector<std::string> plain = {"builtin:object?n=1000", "--size", "48x27", "--timing",
                                            timing};
    std::vector<std::string> traced = plain;
    traced.insert(traced.end(), {"--vcd", scratch.path("wave.vcd")});
    const Simulation a(plain), b(traced);
    CHECK(a.views()[0]["frame"] == b.views()[0]["frame"]);
    CHECK(a.views()[0]["units"] == b.views()[0]["units"]);
    CHECK(a.views()[0]["dram"] == b.views()[0]["dram"]);
  }
}

}  // namespace
}  // namespace sgs::test

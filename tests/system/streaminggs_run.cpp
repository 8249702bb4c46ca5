// Processes and their reports.
#include "tests/system/streaminggs_run.h"

#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/system/frame_checks.h"
#include "tests/system/tile_frame_checks.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

std::string quoted(const std::string& argument) {
  std::string out = "'";
  for (const char c : argument) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void check_frame(const Json& view) {
  view["config"]["machine"] == "gscore" ? check_tile_machine(view) : check_streaming_machine(view);
}

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Arguments settings(const Arguments& assignments) {
  Arguments all;
  for (const std::string& assignment : assignments) {
    all.insert(all.end(), {"--set", assignment});
  }
  return all;
}

Arguments with_settings(const Arguments& first, const Arguments& assignments) {
  return joined(first, settings(assignments));
}

Outcome run_program(const std::string& program, const Arguments& arguments) {
  const ScratchFolder scratch;
  std::string command = quoted(program);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >" + quoted(scratch.path("out")) + " 2>" + quoted(scratch.path("err"));
  const int status = std::system(command.c_str());
  constexpr int kKilled = 128;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : kKilled + WTERMSIG(status),
          bytes_of(scratch.path("out")), bytes_of(scratch.path("err"))};
}

Outcome run_streaminggs(const Arguments& arguments) {
  return run_program(SGS_STREAMINGGS, arguments);
}

std::vector<Json> views_of_report(const std::string& path) {
  const Json report = Json::parse(bytes_of(path));
  std::vector<Json> views;
  for (Json view : report["views"]) {
    view["config"] = report["config"];
    views.push_back(std::move(view));
  }
  return views;
}

Simulation::Simulation(const Arguments& arguments) {
  const Outcome outcome = run_streaminggs(joined(
      joined({"simulate"}, arguments), {"--set", "framebuffer=rgb32f", "--out", out_.path("out")}));
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.err.find("Warning") == std::string::npos);  // a SystemC warning is a failure
  views_ = views_of_report(out_.path("out/report.json"));
  REQUIRE_FALSE(views_.empty());
}

std::string Simulation::frame(std::size_t view) const {
  return bytes_of(
      out_.path("out/view_" + std::to_string(views_[view]["view"].get<int>()) + "/frame.exr"));
}

void Simulation::check() const {
  for (const Json& view : views_) check_frame(view);
}

}  // namespace sgs::test

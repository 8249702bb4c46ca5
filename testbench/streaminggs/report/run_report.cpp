// JSON of a run.
#include "testbench/streaminggs/report/run_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "algorithm/files/input_json.h"
#include "testbench/command_line/version.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/report/report.h"
#include "testbench/streaminggs/report/report_sections.h"
#include "testbench/streaminggs/report/report_visitor.h"
#include "testbench/streaminggs/run/progress.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kConfigMeaning = "Every key of the configuration, resolved.";

// The entries of a view that the run brings. config, chosen: the run's. image_hash: the view's.
void visit_run(ReportVisitor& r, const RunFacts& facts, const Json& config,
               const std::vector<AutoChoice>& chosen, std::uint64_t image_hash) {
  const auto hash = [](std::uint64_t value) { return fmt::format("{:016x}", value); };
  r.object("host", [&] {
    r("wall_s", "s", "Host time since the command began, for all views so far.",
      seconds_since(facts.began));
    r("peak_rss_bytes", "B", "Largest host memory of the process or of a child.", peak_rss_bytes());
  });
  r("config", "", kConfigMeaning, config);
  r.list("chosen", chosen, [&](const AutoChoice& choice) {
    r("key", "", "A key that the configuration leaves open and the model chose.", choice.key);
    r("value", "", "The value that it chose.", choice.value);
    r("why", "", "Why it chose that.", choice.why);
  });
  r.object("provenance", [&] {
    r("version", "", "Version of the program.", version());
    r("commit", "", "Commit of the program, as its build found it.", commit());
    r("memory_image_xxh64", "XXH64",
      "Hash of the bytes loaded into the modelled DRAM: equal hashes, equal input.",
      hash(image_hash));
    r("technology", "", "Name of the table of energy and area.", facts.technology);
    r("technology_path", "", "File of that table.", facts.technology_path);
    r("technology_xxh64", "XXH64", "Hash of that file, as `xxhsum` prints it.",
      hash(facts.technology_hash));
    r("seed", "", "Seed of the random stalls.", facts.seed);
    r("configuration", "",
      "Name of the configuration, and how many `--set` go over it. A sweep's points say it "
      "instead.",
      facts.configuration);
    r("command", "", "The command line.", facts.command);
  });
}

using Failures = std::vector<std::pair<int, std::string>>;

void visit_summary(ReportVisitor& r, const PathSummary& s) {
  r("frames", "", "Frames of the path: `views`, in their order.", s.frames);
  r("worst_fps", "1/s", "Frame rate of the slowest frame.", s.worst_fps);
  r("worst_frame", "", "Number of that frame, from 0.", s.worst_frame);
  r("p99_fps", "1/s", "Frame rate that 99 of 100 frames reach.", s.p99_fps);
  r("median_fps", "1/s", "Frame rate that half of the frames reach.", s.median_fps);
  r("energy_j", "J", "Energy of all frames.", s.energy_j);
  r("memory_known", "bool", "As `fixed_rates[].memory_known`, of all frames.", s.memory_known);
  r("frame_rate", "1/s", "Frames that are begun in a second: `--frame-rate`.", s.rate);
  r("late_frames", "", "Frames after which the next one begins late.", s.late);
  r("empty_frames", "", "Frames to which no Gaussian contributes.", s.empty);
  const Band both = s.frames_w + s.idle_w;
  r("frames_w", "W", "Energy of frames over the time of all.", s.frames_w.middle);
  r("idle_w", "W",
    "Energy between frames over the time of all: leakage, and the memory's rest. None after frames "
    "that are late.",
    s.idle_w.middle);
  r("energy_a_second_j", "J", "Energy a second: of both.", both.middle);
  r("energy_a_second_low_j", "J", "The same with the lowest values of the sources.", both.low);
  r("energy_a_second_high_j", "J", "The same with the highest values.", both.high);
  r("with_memory_interface_w", "W", "Of both, with PHY and controller of the memory.",
    s.with_interface_w.middle);
}

void visit_name(ReportVisitor& r, const std::string& path) {
  r.object("path",
           [&] { r("name", "", "File of `--path`, or the way of a built-in scene.", path); });
}

struct StreamOfAll {
  StreamReport report;
  Json all;
};

// The entries of a report of several views.
void visit_all(ReportVisitor& r, const Json& config, const Failures& failed,
               const std::optional<PathReport>& path, const std::optional<StreamOfAll>& stream,
               const Json& views) {
  r("schema_version", "", "Version of this layout.", kReportVersion);
  r("config", "", kConfigMeaning, config);
  r.list("failed", failed, [&](const auto& failure) {
    r("view", "", "Number of a view that could not be finished.", failure.first);
    r("why", "", "Why not.", failure.second);
  });
  r.each(path, [&](const PathReport& of) {
    visit_name(r, of.name);
    r.object("summary", [&] { visit_summary(r, of.summary); });
  });
  r.each(stream, [&](const StreamOfAll& of) {
    visit_name(r, of.report.name);
    r.object("stream", [&] {
      visit_stream(r, of.report);
      r("all", "",
        "All frames together: the entries of a view but `view`, `camera`, `image`, `limit`, and "
        "what is of a single frame. Its means are over the whole simulation, those of "
        "`stream.flow` over what lies between two pictures.",
        of.all);
    });
  });
  r("views", "",
    "The reports of the views that were finished, or of the frames of a path; none of a stream.",
    views);
}

}  // namespace

struct RunReport::Content {
  Json config, views;
  std::vector<AutoChoice> chosen;
};

RunReport::RunReport(RunConfig& config, RunFacts facts)
    : facts_(std::move(facts)), content_(std::make_unique<Content>()) {
  content_->config = parse_json(to_json(config), "the configuration");
  content_->chosen = config.chosen;
}

RunReport::~RunReport() = default;

std::shared_ptr<const Json> RunReport::of_view(const ViewResult& view,
                                               const PreparedScene& scene) const {
  auto report = std::make_shared<Json>();
  ReportWriter writer(*report);
  visit_view(writer, view, scene);
  visit_run(writer, facts_, content_->config, content_->chosen, view.image_hash);
  return report;
}

Json RunReport::of_all(const ViewResult& all, const PreparedScene& scene) const {
  Json report;
  ReportWriter writer(report);
  visit_view_of_stream(writer, all, scene);
  visit_run(writer, facts_, content_->config, content_->chosen, all.image_hash);
  report.erase("config");  // stands beside it
  return report;
}

void RunReport::add(const Json& view) { content_->views.push_back(view); }

std::string RunReport::text(const Failures& failed) const {
  Json all;
  ReportWriter writer(all);
  visit_all(writer, content_->config, failed, {}, {}, content_->views);
  return report_text(all);
}

std::string RunReport::text(const PathReport& path) const {
  Json all;
  ReportWriter writer(all);
  visit_all(writer, content_->config, {}, path, {}, content_->views);
  return report_text(all);
}

Json RunReport::of_stream(const StreamReport& stream, const Json& all) const {
  Json report;
  ReportWriter writer(report);
  visit_all(writer, content_->config, {}, {}, StreamOfAll{stream, all}, Json::array());
  return report;
}

std::vector<ReportEntry> entries_of_view() {
  ReportTeller teller;
  visit_view(teller, ViewResult(), PreparedScene());
  visit_run(teller, RunFacts(), {}, {}, 0);
  return teller.entries();
}

std::vector<ReportEntry> entries_of_all_views() {
  ReportTeller teller;
  visit_all(teller, {}, {}, {}, {}, {});
  return teller.entries();
}

// A scene's name may be any bytes.
std::string report_text(const Json& report) {
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sgs

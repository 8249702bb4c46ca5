// JSON of a run.
#include "testbench/streaminggs/report/run_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithm/files/input_json.h"
#include "testbench/command_line/version.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/report/report.h"
#include "testbench/streaminggs/run/seconds_since.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

Json list_choices(const std::vector<AutoChoice>& chosen) {
  Json list = Json::array();
  for (const AutoChoice& choice : chosen) {
    list.push_back({{"key", choice.key}, {"value", choice.value}, {"why", choice.why}});
  }
  return list;
}

}  // namespace

struct RunReport::Content {
  Json config, chosen, views;
};

RunReport::RunReport(RunConfig& config, RunFacts facts)
    : facts_(std::move(facts)), content_(std::make_unique<Content>()) {
  content_->config = parse_json(to_json(config), "the configuration");
  content_->chosen = list_choices(config.chosen);
}

RunReport::~RunReport() = default;

std::shared_ptr<const Json> RunReport::of_view(const ViewResult& view,
                                               const PreparedScene& scene) const {
  auto report = std::make_shared<Json>(view_report(view, scene));
  Json& out = *report;
  out["config"] = content_->config;
  out["chosen"] = content_->chosen;
  out["host"]["wall_s"] = seconds_since(facts_.began);
  out["host"]["peak_rss_bytes"] = peak_rss_bytes();
  out["provenance"] = {{"version", version()},
                       {"commit", commit()},
                       {"memory_image_xxh64", fmt::format("{:016x}", view.image_hash)},
                       {"technology", facts_.technology},
                       {"technology_path", facts_.technology_path},
                       {"technology_xxh64", fmt::format("{:016x}", facts_.technology_hash)},
                       {"seed", facts_.seed},
                       {"configuration", facts_.configuration},
                       {"command", facts_.command}};
  return report;
}

void RunReport::add(const Json& view) { content_->views.push_back(view); }

std::string RunReport::text(const std::vector<std::pair<int, std::string>>& failed) const {
  Json all;
  all["schema_version"] = kReportVersion;
  all["config"] = content_->config;
  all["failed"] = Json::array();
  for (const auto& [view, why] : failed) all["failed"].push_back({{"view", view}, {"why", why}});
  all["views"] = content_->views;
  return report_text(all);
}

// A scene's name may be any bytes.
std::string report_text(const Json& report) {
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sgs

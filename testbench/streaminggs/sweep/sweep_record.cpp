// Members of a line, and what is left of a report.
#include "testbench/streaminggs/sweep/sweep_record.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// Names may be any bytes.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json settings_of(const std::vector<std::string>& overrides) {
  Json out = Json::object();
  for (const std::string& assignment : overrides) {
    const std::size_t equals = assignment.find('=');
    const std::string value = assignment.substr(std::min(equals + 1, assignment.size()));
    Json parsed = Json::parse(value, nullptr, false);
    out[assignment.substr(0, equals)] = parsed.is_discarded() ? Json(value) : std::move(parsed);
  }
  return out;
}

Json json_of(const PointInWords& point) {
  Json out = {{"scene", point.scene}};
  if (!point.cameras.empty()) out["cameras"] = point.cameras;
  int view = 0;
  const char* const end = point.view.data() + point.view.size();
  const auto [stop, error] = std::from_chars(point.view.data(), end, view);
  const bool number = error == std::errc() && stop == end;
  out["view"] = number ? Json(view) : Json(point.view);
  if (!point.size.empty()) out["size"] = point.size;
  if (!point.stereo.empty()) out["stereo"] = point.stereo;
  out["config"] = point.config;
  if (point.fit_memories) out["fit_memories"] = true;
  out["set"] = settings_of(point.overrides);
  return out;
}

Json head_of(const std::string& key, const char* status, const PointInWords& point) {
  return {{"key", key}, {"status", status}, {"point", json_of(point)}};
}

// Of an area its whole band alone.
void keep_total_band(Json& area_mm2) {
  if (const auto bands = area_mm2.find("bands"); bands != area_mm2.end()) {
    *bands = {{"total", bands->at("total")}};
  }
}

void drop(Json& from, const char* section, const char* part) {
  if (const auto found = from.find(section); found != from.end()) found->erase(part);
}

Json kept_of(Json report) {
  for (const char* part : {"ledger", "left_out", "datapath"}) report.erase(part);
  drop(report, "sram", "uses");
  drop(report, "energy", "bands");
  drop(report, "memory_interface", "area_source");
  if (report.contains("area_mm2")) keep_total_band(report["area_mm2"]);
  for (const char* key : {"command", "configuration"}) drop(report, "provenance", key);
  report["host"] = {{"simulation_wall_s", report["host"]["simulation_wall_s"]}};
  for (auto& [path, unit] : report["units"].items()) {
    for (auto& [name, activity] : unit["activities"].items()) activity.erase("waits");
  }
  return report;
}

}  // namespace

std::string line_of_done(const std::string& key, const PointInWords& point, const Json& report) {
  Json line = head_of(key, kPointDone, point);
  line["report"] = kept_of(report);
  return text_of(line);
}

std::string line_of_refused(const std::string& key, const PointInWords& point,
                            const std::string& why) {
  Json line = head_of(key, kPointRefused, point);
  line["reason"] = why;
  return text_of(line);
}

std::string line_of_failed(const std::string& key, const PointInWords& point,
                           const std::string& why, int attempts) {
  Json line = head_of(key, kPointFailed, point);
  line["attempts"] = attempts;
  line["reason"] = why;
  return text_of(line);
}

std::string answer_of(const std::string& line, const std::string& id, const PointInWords& point,
                      bool kept) {
  Json answer = Json::object();
  if (!id.empty()) answer["id"] = Json::parse(id);
  answer["kept"] = kept;
  answer.update(Json::parse(line));
  answer["point"] = json_of(point);
  return text_of(answer);
}

bool holds_no_gaussian(const std::string& line) {
  const Json result = Json::parse(line);
  return result["status"] == kPointDone && result["report"]["image"]["empty"] == true;
}

std::string in_short(const std::string& line) {
  const Json result = Json::parse(line);
  const Json& point = result["point"];
  std::string text = point["scene"];
  if (point["view"].is_number()) text += " view " + point["view"].dump();
  if (point.contains("size")) text += " " + point["size"].get<std::string>();
  if (point.contains("stereo")) text += " --stereo " + point["stereo"].get<std::string>();
  text += " " + point["config"].get<std::string>();
  if (point.contains("fit_memories")) text += " --fit-memories";
  for (const auto& [key, value] : point["set"].items()) {
    text += " " + key + "=" + (value.is_string() ? value.get<std::string>() : text_of(value));
  }
  return text + ": " + result["reason"].get<std::string>();
}

}  // namespace sgs

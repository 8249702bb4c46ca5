// Grids, lists and JSON lines.
#include "testbench/streaminggs/sweep/sweep_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/files/input_json.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBlanks = " \t\r\n";
// More than anybody can wait for; what makes such a grid is a mistake.
constexpr std::size_t kMostPoints = 100'000;

std::string key_of(const std::string& assignment) {
  return assignment.substr(0, assignment.find('='));
}

// "KEY=V1,V2" as "KEY=V1", "KEY=V2".
std::vector<std::string> values_of_axis(const std::string& axis) {
  const auto refuse = [&](const char* expected) {
    throw InputError(fmt::format("--axis: got '{}', expected {}", axis, expected));
  };
  const std::size_t equals = axis.find('=');
  if (equals == std::string::npos || equals == 0) refuse("KEY=VALUE,VALUE,...");
  std::vector<std::string> assignments;
  std::istringstream values(axis.substr(equals + 1) + ",");
  for (std::string value; std::getline(values, value, ',');) {
    if (value.empty()) refuse("KEY=VALUE,VALUE,...");
    const std::string assignment = axis.substr(0, equals + 1) + value;
    if (std::find(assignments.begin(), assignments.end(), assignment) != assignments.end()) {
      refuse("different values");
    }
    assignments.push_back(assignment);
  }
  return assignments;
}

std::string text_at(const JsonPlace& point, const char* key) {
  const auto found = point.find(key);
  if (!found) return {};
  if (found->text().empty()) found->refuse("a text");
  return found->text();
}

std::string view_at(const JsonPlace& point) {
  const auto found = point.find("view");
  if (found && found->json().is_number_unsigned()) return found->json().dump();
  return text_at(point, "view");
}

std::vector<std::string> overrides_at(const JsonPlace& point) {
  const auto found = point.find("set");
  if (!found) return {};
  if (!found->json().is_object()) found->refuse("{\"key.path\": value, ...}");
  std::vector<std::string> overrides;
  for (const auto& [key, value] : found->members()) {
    overrides.push_back(key + "=" + shown(value.json()));
  }
  return overrides;
}

SweepPoint point_of_json(const std::string& line, const std::string& origin) {
  const Json json = parse_json(line, origin);
  const JsonPlace place(origin, json);
  place.expect_only(
      {"id", "scene", "cameras", "view", "size", "stereo", "config", "fit_memories", "set"});
  SweepPoint point;
  if (const auto id = place.find("id")) point.id = shown(id->json());
  point.scene = text_at(place, "scene");
  point.cameras = text_at(place, "cameras");
  point.view = view_at(place);
  point.size = text_at(place, "size");
  point.stereo = text_at(place, "stereo");
  point.config = text_at(place, "config");
  if (const auto fit = place.find("fit_memories")) point.fit_memories = fit->flag();
  point.overrides = overrides_at(place);
  return point;
}

}  // namespace

std::vector<SweepPoint> grid_of(const std::vector<std::string>& axes) {
  std::vector<SweepPoint> points(1);
  std::vector<std::string> keys;
  for (const std::string& axis : axes) {
    const std::vector<std::string> assignments = values_of_axis(axis);
    const std::string key = key_of(assignments.front());
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) {
      throw InputError(fmt::format("--axis: got {} twice, expected once", key));
    }
    keys.push_back(key);
    if (points.size() * assignments.size() > kMostPoints) {
      throw InputError(
          fmt::format("--axis: got a grid of more than {} points, expected fewer", kMostPoints));
    }
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points) {
      for (const std::string& assignment : assignments) {
        longer.push_back(point);
        longer.back().overrides.push_back(assignment);
      }
    }
    points = std::move(longer);
  }
  return points;
}

SweepPoint parse_point(const std::string& line, const std::string& place) {
  if (line.front() == '{') return point_of_json(line, place);
  SweepPoint point;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(
          fmt::format("{}: got '{}', expected KEY=VALUE ..., or a JSON object", place, word));
    }
    const auto same = [&](const std::string& other) { return key_of(other) == key_of(word); };
    if (std::any_of(point.overrides.begin(), point.overrides.end(), same)) {
      throw InputError(fmt::format("{}: got {} twice, expected once", place, key_of(word)));
    }
    point.overrides.push_back(word);
  }
  return point;
}

std::string content_of(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string::npos || line[begin] == '#') return {};
  const bool json = line[begin] == '{';
  // A # in a word is part of it, as in the name of a file.
  const std::size_t comment = std::min(line.find(" #", begin), line.find("\t#", begin));
  const std::string said = line.substr(0, json ? std::string::npos : comment);
  const std::size_t end = said.find_last_not_of(kBlanks);
  return end == std::string::npos ? "" : said.substr(begin, end + 1 - begin);
}

std::vector<SweepPoint> read_points(const std::string& path) {
  const InputFile file(path);
  std::istringstream lines(file.text_from(0, file.size_bytes()));
  std::vector<SweepPoint> points;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string content = content_of(line);
    if (content.empty()) continue;
    points.push_back(parse_point(content, fmt::format("{}:{}", path, number)));
  }
  if (points.empty()) {
    throw InputError(
        fmt::format("{}: holds no points, expected KEY=VALUE ..., or a JSON object, on "
                    "each line",
                    path));
  }
  return points;
}

}  // namespace sgs

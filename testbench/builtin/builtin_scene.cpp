// The spec of built-in scenes (builtin_scene.h): "builtin:NAME?n=COUNT".
#include "testbench/builtin/builtin_scene.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string_view>

#include "algorithm/files/input_error.h"
#include "testbench/builtin/capture_scene.h"
#include "testbench/builtin/object_scene.h"
#include "testbench/builtin/outdoor_scene.h"

namespace sgs {

namespace {

constexpr std::string_view kPrefix = "builtin:";
constexpr std::uint64_t kMaxCount = 20'000'000;

struct Recipe {
  std::uint64_t default_count;
  BuiltinScene (*make)(std::uint64_t count);
  BuiltinPath (*path)();
};

const std::map<std::string, Recipe>& recipes() {
  static const std::map<std::string, Recipe> kRecipes = {
      {"capture", {1'000'000, make_capture_scene, capture_ring}},
      {"object", {60'000, make_object_scene, object_turntable}},
      {"outdoor", {200'000, make_outdoor_scene, outdoor_walk}}};
  return kRecipes;
}

// The value of "n=COUNT".
std::uint64_t count_of(const std::string& spec, const std::string& query) {
  std::uint64_t count = 0;
  const char* end = query.data() + query.size();
  if (query.rfind("n=", 0) == 0) {
    const auto [stop, error] = std::from_chars(query.data() + 2, end, count);
    if (error == std::errc() && stop == end && count >= 1 && count <= kMaxCount) return count;
  }
  throw InputError(fmt::format("{}: got \"{}\" after the question mark, expected n=1 to n={}", spec,
                               query, kMaxCount));
}

struct Order {
  const Recipe& recipe;
  std::uint64_t count;
};

Order order_of(const std::string& spec) {
  const std::string rest = is_builtin_scene(spec) ? spec.substr(kPrefix.size()) : "";
  const std::size_t mark = rest.find('?');
  const auto recipe = recipes().find(rest.substr(0, mark));
  if (recipe == recipes().end()) {
    std::vector<std::string> names;
    for (const auto& [name, ignored] : recipes()) names.push_back("builtin:" + name);
    const std::string question = did_you_mean(spec.substr(0, spec.find('?')), names);
    throw InputError(fmt::format("{}: no such built-in scene{}one of {}", spec,
                                 then_expected(question), join(names, " ")));
  }
  const Recipe& chosen = recipe->second;
  return {chosen,
          mark == std::string::npos ? chosen.default_count : count_of(spec, rest.substr(mark + 1))};
}

}  // namespace

bool is_builtin_scene(const std::string& spec) { return spec.rfind(kPrefix, 0) == 0; }

BuiltinScene make_builtin_scene(const std::string& spec) {
  const Order order = order_of(spec);
  return order.recipe.make(order.count);
}

BuiltinPath builtin_path(const std::string& spec) { return order_of(spec).recipe.path(); }

Camera look_at(int id, const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
               double fov_degrees) {
  constexpr glm::dvec3 kDown(0.0, 1.0, 0.0);
  Camera camera;
  camera.id = id;
  camera.name = name;
  camera.width = 640;
  camera.height = 360;
  camera.focal_x = 0.5 * camera.width / std::tan(0.5 * fov_degrees * M_PI / 180.0);
  camera.focal_y = camera.focal_x;
  camera.position = eye;
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(kDown, forward));
  camera.world_from_camera = glm::dmat3(right, glm::cross(forward, right), forward);
  return camera;
}

}  // namespace sgs

// What all commands on a scene have in common: SCENE, --cameras, --view, --size, --drop-invalid.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/load_scene.h"

namespace CLI {
class App;
}

namespace sgs {

struct SceneArguments {
  std::string scene;
  std::string cameras_path;   // empty: the cameras of a built-in scene
  std::string view = "0";     // a number or "all"
  std::string size;           // "WxH" or empty
  std::vector<int> weigh_by;  // numbers of cameras; empty: all
  bool drop_invalid = false;

  void add_scene_to(CLI::App& app);
  void add_views_to(CLI::App& app);

  void add_weighing_to(CLI::App& app);

  Scene load() const;
  // Cameras of the chosen views with their numbers, scaled to `size`. Throws InputError.
  std::vector<std::pair<int, Camera>> cameras(const Scene& loaded) const;
  // Those that weigh the Gaussians of a scene for vector quantisation, in their own size; none
  // where there are none. Throws InputError.
  std::vector<Camera> weighing_cameras(const Scene& loaded) const;
};

}  // namespace sgs

// The arguments that all commands on a scene have in common: SCENE, --cameras, --view, --size,
// --drop-invalid, --level, --scene-axes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/files/output_file.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/scene_files/load_scene.h"
#include "algorithm/splat/rects.h"
#include "algorithm/storage/image_file.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

constexpr const char* kUnpackedSceneForms =
    "a scene (.ply, .spz, .sog, .splat, .ksplat, .glb, a SOG folder) or builtin:NAME?n=COUNT";
constexpr const char* kSceneForms =
    "a scene (.ply, .spz, .sog, .splat, .ksplat, .glb, a SOG folder), builtin:NAME?n=COUNT, or a "
    ".sgs file made by pack";

// Cameras with their numbers, and lines for the terminal: what their size does to the shape of the
// picture where that is another than theirs, and what their file says that frames do not show.
struct ChosenCameras {
  std::vector<std::pair<int, Camera>> views;
  std::vector<std::string> notes;
};

struct SceneArguments {
  std::string scene;
  const char* scene_forms = kSceneForms;
  std::string cameras_path;   // file or folder; empty: the cameras of a built-in scene
  std::string view = "0";     // numbers, separated by commas, or "all"
  std::string size;           // "WxH" or empty
  std::vector<int> weigh_by;  // numbers of cameras; empty: all
  bool drop_invalid = false;
  std::optional<std::uint32_t> level;  // of detail, see SceneReadOptions
  std::string axes;                    // of the scene, as there
  std::string cache;                   // cache of codebooks, as CodebookCache takes it

  SceneReadOptions reading() const { return {drop_invalid, level, axes}; }

  // forms: what SCENE may be.
  void add_scene_to(CommandLine& line, const char* forms = kSceneForms);
  void add_views_to(CommandLine& line);
  // Those arguments of the two above that hold for several scenes.
  void add_reading_to(CommandLine& line);
  void add_choice_of_views_to(CommandLine& line);

  void add_weighing_to(CommandLine& line);
  void add_cache_to(CommandLine& line);

  // Where to write what the user gave no place for: out/, the scene's name, the configuration's.
  std::string default_out(const std::string& config_name) const;
  // No output may take the place of the scene or the cameras.
  void add_inputs_to(OutputPlan& plan) const;

  // Throws InputError when SCENE is neither a built-in one nor of a form that load_scene() knows.
  void check_file() const;
  // Throws InputError, also when check_file() does, or when --drop-invalid leaves nothing. What is
  // to be noted of the file goes to stderr.
  Scene load() const;
  // The same without a word.
  Scene load_silently() const;
  // The scene where it is a file made by pack, else nothing. Throws InputError, also for arguments
  // that only a scene that is not packed yet can take.
  std::optional<PackedScene> load_packed() const;
  // Throws InputError for arguments that only a file of Gaussians can take, where any is given.
  // what: that SCENE is, in words.
  void refuse_reading(const std::string& what) const;
  // Those of the chosen views, scaled to `size`. own: those that the scene brings. Throws
  // InputError.
  ChosenCameras chosen_cameras(const std::vector<Camera>& own) const;
  // The same; the lines go to the terminal.
  std::vector<std::pair<int, Camera>> cameras(const std::vector<Camera>& own) const;
  // These, scaled and checked in the same way. origin: where they come from, for messages.
  ChosenCameras in_size(std::vector<std::pair<int, Camera>> cameras,
                        const std::string& origin) const;
  // Sizes of their pictures, before the scene is loaded: none where nothing but the scene says
  // them. Throws InputError.
  std::vector<PixelSize> frame_sizes() const;
  // Those that weigh the Gaussians of a scene for vector quantisation, in their own size; none
  // where there are none. Throws InputError, also where --weigh-by is given and the encoding is not
  // quantised.
  std::vector<Camera> weighing_cameras(const std::vector<Camera>& own,
                                       SecondHalfEncoding encoding) const;

 private:
  // Those of the file, where one is given: InputError when it holds none.
  ViewCameras all_cameras(const std::vector<Camera>& own) const;
  const std::string& origin_of_cameras() const {
    return cameras_path.empty() ? scene : cameras_path;
  }
};

}  // namespace sgs

// streaminggs render SCENE --out FILE
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "algorithm/image/image_io.h"
#include "algorithm/input_error.h"
#include "algorithm/memory/restore_scene.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/scene_arguments.h"

namespace sgs {
namespace {

// What to render; with tables where it is packed for one of the streaming orders.
struct RenderedScene {
  ActivatedCloud cloud;
  std::vector<Camera> cameras;
  ChunkTree tree;
  VoxelGrid grid;
};

RenderedScene load(const SceneArguments& arguments) {
  if (auto packed = arguments.load_packed()) {
    StoredScene stored = restore_scene(std::move(*packed), arguments.scene);
    return {std::move(stored.decoded), {}, std::move(stored.tree), std::move(stored.grid)};
  }
  Scene scene = arguments.load();
  return {activate(scene.cloud), std::move(scene.cameras), {}, {}};
}

}  // namespace

SubCommand add_render_command(CLI::App& app) {
  struct Arguments : SceneArguments {
    std::string out;
    std::string ordering = "reference";
    int group_px = PaperOrderConfig{}.group_px;
    float voxel_size = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(app);
  arguments->add_views_to(app);
  app.add_option("--out", arguments->out, "image: .exr, .pfm or .png")->required();
  app.add_option("--ordering", arguments->ordering, "how splats are ordered")
      ->check(CLI::IsMember({"reference", "paper", "exact"}))
      ->capture_default_str();
  app.add_option("--group", arguments->group_px, "streaming orders: side of a pixel group")
      ->check(CLI::Range(4, 1020))
      ->capture_default_str();
  app.add_option("--voxel-size", arguments->voxel_size,
                 "paper order: world units; 0: as packed, or from the scene's extent");
  return [arguments] {
    RenderedScene scene = load(*arguments);
    const auto views = arguments->cameras(scene.cameras);
    if (views.size() != 1)
      throw InputError("--view: 'all' writes more than one image, expected a number");
    if (arguments->group_px % 4 != 0) throw InputError("--group: expected a multiple of 4");
    const View<float> view = make_view<float>(views.front().second);
    const ActivatedCloud& cloud = scene.cloud;
    if (arguments->ordering == "reference") {
      write_image(arguments->out, render_reference(view, cloud).image);
      return 0;
    }
    if (arguments->ordering == "exact") {
      ExactOrderConfig config;
      config.group_px = arguments->group_px;
      constexpr std::uint32_t kChunkGaussians = 16;
      if (scene.tree.nodes.empty()) scene.tree = build_chunk_tree(cloud, kChunkGaussians);
      write_image(arguments->out, render_exact_order(view, cloud, scene.tree, config).frame.image);
      return 0;
    }
    if (arguments->voxel_size > 0 || scene.grid.nodes.empty()) {
      scene.grid = build_voxel_grid(
          cloud, arguments->voxel_size > 0 ? arguments->voxel_size : paper_voxel_size(cloud));
    }
    PaperOrderConfig config;
    config.group_px = arguments->group_px;
    const StreamingResult result = render_paper_order(view, cloud, scene.grid, config);
    write_image(arguments->out, result.frame.image);
    fmt::print("missed {} (group, splat) pairs\nmisordered {} of {} blends\n", result.stats.missed,
               result.stats.misordered, result.stats.contributors);
    return 0;
  };
}

}  // namespace sgs

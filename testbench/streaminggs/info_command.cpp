// streaminggs info SCENE|DATASET
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "algorithm/dataset/dataset.h"
#include "algorithm/dataset/view_cameras.h"
#include "algorithm/files/input_error.h"
#include "algorithm/scene/describe.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/voxel/voxel_grid.h"
#include "testbench/command_line/guard.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/describe_packed.h"
#include "testbench/streaminggs/fitting/dataset_arguments.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

void print_voxels(const ActivatedCloud& cloud) {
  const auto voxel_size = static_cast<float>(choose_voxel_size(cloud).value);
  print_fact("voxel size", rounded(voxel_size) + " world units");
  try {
    const VoxelGrid grid = arrange_by_voxels(cloud, voxel_size).table;
    print_fact("occupied voxels", grouped(grid.voxels.size()));
    print_fact("tree nodes", grouped(grid.nodes.size()));
  } catch (const InputError& error) {
    // Stored by chunks it can be drawn all the same.
    print_fact("occupied voxels", std::string("none: ") + error.what());
  }
}

struct InfoArguments : SceneArguments {
  DatasetArguments data;
};

void print_dataset_in(const InfoArguments& arguments) {
  const std::string& folder = arguments.scene;
  arguments.refuse_reading("is a folder of photographs");
  print_dataset(while_doing("reading " + folder,
                            [&] { return open_dataset(folder, arguments.data.options); }));
}

// Sizes of pictures and how many have them.
void print_cameras_in(const std::string& file) {
  const ViewCameras read = while_doing("reading " + file, [&] { return read_view_cameras(file); });
  std::map<std::pair<int, int>, std::size_t> sizes;
  for (const Camera& camera : read.cameras) ++sizes[{camera.width, camera.height}];
  print_fact("cameras", grouped(read.cameras.size()));
  for (const auto& [size, count] : sizes) {
    print_fact("size", fmt::format("{}x{} px ({})", size.first, size.second, grouped(count)));
  }
  if (!read.note.empty()) print_fact("note", read.note);
}

}  // namespace

SubCommand add_info_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<InfoArguments>();
  arguments->add_scene_to(line,
                          "a scene (.ply, .spz, .sog, .splat, .ksplat, .glb, a SOG folder), "
                          "builtin:NAME?n=COUNT, a .sgs file made by pack, the folder of a data "
                          "set, or a .json file of cameras");
  arguments->data.add_options_to(line);
  return [arguments, &kinds] {
    std::error_code unknown;
    if (std::filesystem::is_directory(arguments->scene, unknown) &&
        !is_scene_file(arguments->scene)) {
      print_dataset_in(*arguments);
      return 0;
    }
    if (std::filesystem::path(arguments->scene).extension() == ".json") {
      print_cameras_in(arguments->scene);
      return 0;
    }
    if (const auto packed = arguments->load_packed()) {
      print_fact("memory image, version", std::to_string(kImageFileVersion));
      print_fact("checksum", fmt::format("{:08x} (CRC-32)", packed->checksum));
      print_packed(packed->facts, packed->storage, packed->image.layout,
                   readers_of(kinds, packed->storage.order));
      return 0;
    }
    const Scene scene = arguments->load_silently();
    const SceneSummary s = summarise(scene.cloud);
    if (!scene.form.empty()) print_fact("form", scene.form);
    for (const std::string& note : scene.notes) print_fact("note", one_line(note));
    print_fact("gaussians", grouped(s.count));
    print_fact("dropped invalid", grouped(scene.dropped_invalid) + " Gaussians");
    print_fact("sh degree", std::to_string(s.sh_degree));
    print_fact("extent, all", in_words(s.extent));
    print_fact("extent, 0.1 .. 99.9 %", in_words(s.inner_extent));
    print_fact("never visible", grouped(s.invisible_count) + " Gaussians (opacity < 1/255)");
    print_fact("median opacity", rounded(s.median_opacity));
    print_fact("median largest scale", rounded(s.median_scale) + " world units");
    print_fact("largest scale", rounded(s.max_scale) + " world units");
    print_fact("largest scale ratio", rounded(s.max_scale_ratio));
    print_fact("first halves, by voxels", grouped(s.first_half_bytes) + " B, raw");
    print_fact("second halves, by voxels", grouped(s.second_half_bytes) + " B, raw");
    if (!scene.cameras.empty()) print_fact("cameras", grouped(scene.cameras.size()));
    print_voxels(activate(scene.cloud));
    return 0;
  };
}

}  // namespace sgs

// Readers of scenes, cameras, pictures and data sets.
#include "algorithm/dataset/dataset.h"
#include "algorithm/dataset/view_cameras.h"
#include "algorithm/image/image_formats.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/fuzz/few_views.h"
#include "tests/fuzz/fuzzed_reader.h"
#include "tests/fuzz/zero_runs.h"

namespace sgs::test {
namespace {

using WriteDataset = void (*)(const std::string& folder, const PhotographedScene& scene);

FuzzedReader dataset_reader(const std::string& name, WriteDataset write, const std::string& file) {
  return {name, file, [](const std::string& folder) { open_dataset(folder); },
          [write](const std::string& folder) { write(folder, few_views()); }};
}

// Of a scene at `path` below the folder; the name says its form, where its bytes do not.
FuzzedReader scene_reader(const std::string& name, const std::string& file,
                          const std::string& path) {
  return {name, file, [path](const std::string& folder) {
            SceneReadOptions dropping;
            dropping.drop_invalid = true;
            load_scene(folder + "/" + path, dropping);
          }};
}
FuzzedReader scene_reader(const std::string& name, const std::string& file) {
  return scene_reader(name, file, file);
}

// Of one file of a SOG, the others of which stand in `below`.
FuzzedReader sog_reader(const std::string& name, const std::string& file, const std::string& path,
                        const std::string& below) {
  FuzzedReader reader = scene_reader(name, file, path);
  reader.prepare = [below](const std::string& folder) {
    for (const Part& part : sog_parts(3, 1)) write_file(folder, below + part.name, part.bytes);
  };
  return reader;
}

// The headers of .ksplat are mostly zeros, in which a mutation finds nothing.
FuzzedReader ksplat_reader() {
  FuzzedReader reader = scene_reader("ksplat", "a.ksplat");
  reader.file_of = [](const std::string& bytes) { return with_runs(bytes); };
  return reader;
}

}  // namespace

const std::vector<FuzzedReader>& fuzzed_readers() {
  static const std::vector<FuzzedReader> readers = {
      {"ply", "a.ply",
       [](const std::string& folder) {
         SceneReadOptions dropping;
         dropping.drop_invalid = true;
         read_ply(folder + "/a.ply", dropping);
         read_ply(folder + "/a.ply");
       }},
      scene_reader("splat", "a.splat"),
      scene_reader("compressed_ply", "a.ply"),
      scene_reader("spz", "a.spz"),
      scene_reader("sog", "a.sog"),
      sog_reader("sog_meta", "meta.json", "meta.json", ""),
      sog_reader("sog_picture", "sh0.webp", "meta.json", ""),
      sog_reader("streamed_sog", "lod-meta.json", "lod-meta.json", "0_0/"),
      ksplat_reader(),
      scene_reader("gltf", "a.glb"),
      {"cameras", "a.json",
       [](const std::string& folder) { read_view_cameras(folder + "/a.json"); }},
      {"png", "a.png",
       [](const std::string& folder) {
         read_png_header(folder + "/a.png");
         read_png(folder + "/a.png");
       }},
      {"jpeg", "a.jpg",
       [](const std::string& folder) {
         read_jpeg_header(folder + "/a.jpg");
         read_jpeg(folder + "/a.jpg");
       }},
      {"webp", "a.webp",
       [](const std::string& folder) {
         read_webp_header(folder + "/a.webp");
         read_webp(folder + "/a.webp");
       }},
      {"tiff", "a.tif",
       [](const std::string& folder) {
         read_tiff_header(folder + "/a.tif");
         read_tiff(folder + "/a.tif");
       }},
      {"view_cameras", "a.json",
       [](const std::string& folder) { read_view_cameras(folder + "/a.json"); }},
      {"exr", "a.exr", [](const std::string& folder) { read_exr(folder + "/a.exr"); }},
      {"pfm", "a.pfm", [](const std::string& folder) { read_pfm(folder + "/a.pfm"); }},
      dataset_reader("dataset_cameras", write_cameras_json, "cameras.json"),
      dataset_reader("transforms", write_transforms, "transforms.json"),
      dataset_reader("transforms_points", write_transforms_with_points, "points.ply"),
      dataset_reader("split_transforms", write_nerf_synthetic, "transforms_train.json"),
      dataset_reader("colmap_cameras_bin", write_colmap_binary, "sparse/0/cameras.bin"),
      dataset_reader("colmap_images_bin", write_colmap_binary, "sparse/0/images.bin"),
      dataset_reader("colmap_points_bin", write_colmap_binary, "sparse/0/points3D.bin"),
      dataset_reader("colmap_cameras_txt", write_colmap_text, "sparse/0/cameras.txt"),
      dataset_reader("colmap_images_txt", write_colmap_text, "sparse/0/images.txt"),
      dataset_reader("colmap_points_txt", write_colmap_text, "sparse/0/points3D.txt"),
      dataset_reader("nsvf_intrinsics", write_nsvf_matrix, "intrinsics.txt"),
      dataset_reader("nsvf_pose", write_nsvf_matrix, "pose/0_0000.txt"),
      dataset_reader("nsvf_bbox", write_nsvf_matrix, "bbox.txt"),
  };
  return readers;
}

}  // namespace sgs::test

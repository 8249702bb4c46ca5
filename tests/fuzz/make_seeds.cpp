// usage: make_seeds CORPUS. Writes CORPUS/READER/good_* for the readers whose files are not made by
// hand; again where a format of the project has changed.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "algorithm/image/image_formats.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/train/checkpoint.h"
#include "tests/algorithm/image/jpeg_bytes.h"
#include "tests/algorithm/image/photograph_bytes.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/algorithm/storage/packed_scenes.h"
#include "tests/fuzz/few_views.h"
#include "tests/fuzz/zero_runs.h"

namespace sgs::test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The file of a data set that is fuzzed.
struct DatasetSeed {
  const char* reader;
  void (*write)(const std::string& folder, const PhotographedScene& scene);
  const char* file;
};

constexpr DatasetSeed kDatasetSeeds[] = {
    {"dataset_cameras", write_cameras_json, "cameras.json"},
    {"transforms", write_transforms, "transforms.json"},
    {"split_transforms", write_nerf_synthetic, "transforms_train.json"},
    {"colmap_cameras_bin", write_colmap_binary, "sparse/0/cameras.bin"},
    {"colmap_images_bin", write_colmap_binary, "sparse/0/images.bin"},
    {"colmap_points_bin", write_colmap_binary, "sparse/0/points3D.bin"},
    {"colmap_cameras_txt", write_colmap_text, "sparse/0/cameras.txt"},
    {"colmap_images_txt", write_colmap_text, "sparse/0/images.txt"},
    {"colmap_points_txt", write_colmap_text, "sparse/0/points3D.txt"},
    {"nsvf_intrinsics", write_nsvf_matrix, "intrinsics.txt"},
    {"nsvf_pose", write_nsvf_matrix, "pose/0_0000.txt"},
    {"nsvf_bbox", write_nsvf_matrix, "bbox.txt"},
};

void make_datasets(const std::string& corpus, const fs::path& scratch) {
  for (const DatasetSeed& seed : kDatasetSeeds) {
    const fs::path folder = scratch / seed.reader;
    seed.write(folder.string(), few_views());
    const std::string extension = fs::path(seed.file).extension().string();
    write_file(corpus, seed.reader + ("/good_made" + extension), bytes_of(folder / seed.file));
  }
}

void make_pictures(const std::string& corpus) {
  const PhotographedScene scene = few_views();
  const RgbaImage picture = picture_of(scene, scene.cameras[0]);
  const Image small = over(area_averaged(picture, 4, 3), glm::vec3(0.4f));
  write_file(corpus, "png/good_rgba.png", rgba_png(picture));
  write_file(corpus, "png/good_rgb.png", grey_before_png(picture));
  write_file(corpus, "exr/good_zip.exr", encode_exr(small));
  write_file(corpus, "pfm/good_colour.pfm", encode_pfm(small));
  const std::vector<std::uint8_t> samples(16 * 12 * 4, 90);
  write_file(corpus, "webp/good_lossless.webp", webp_bytes(16, 12, samples));
  write_file(corpus, "tiff/good_deflated.tif", tiff_bytes(16, 12, samples));
  write_file(corpus, "tiff/good_big_endian.tif", tiff_bytes(16, 12, samples, {16, true, false, 1}));
  write_file(corpus, "tiff/bad_turned.tif", tiff_bytes(16, 12, samples, {8, false, false, 6}));
  write_file(corpus, "jpeg/good_grey.jpg", jpeg_bytes(16, 12, 1, samples));
  write_file(corpus, "jpeg/good_progressive.jpg", jpeg_bytes(16, 12, 3, samples, true));
  write_file(corpus, "jpeg/bad_cmyk.jpg", jpeg_bytes(16, 12, 4, samples));
}

void make_scenes(const std::string& corpus) {
  GaussianCloud cloud;
  for (int i = 0; i < 2; ++i) {
    cloud.means.emplace_back(i, 2, 3);
    cloud.log_scales.emplace_back(-3, -4, -5);
    cloud.quats.push_back({1, 0, 0, 0.5f});
    cloud.opacity_logits.push_back(0.5f);
    cloud.sh_coeffs.emplace_back(0.1f, 0.2f, 0.3f);
  }
  fs::create_directories(corpus + "/ply");
  write_ply(corpus + "/ply/good_binary.ply", cloud);
  fs::create_directories(corpus + "/packed");
  constexpr const char* kOrders[] = {"voxels", "chunks", "file"};
  constexpr const char* kEncodingNames[] = {"raw", "half", "vq", "vq_packed"};
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      const Packing packing = make_packing(cut_object(6, 0), encoding, order);
      const std::string path = corpus + "/packed/good_" + kOrders[static_cast<int>(order)] + "_" +
                               kEncodingNames[static_cast<int>(encoding)];
      write_image_file(path, packing.facts, packing.stored.storage, packing.stored.image);
      const std::string bytes = bytes_of(path);
      std::ofstream(path, std::ios::binary) << without_runs(bytes);
    }
  }
  fs::create_directories(corpus + "/checkpoint");
  write_checkpoint(corpus + "/checkpoint/good_short",
                   {"train", "--rate 1", "digest", "{}\n", 2.5, "state"});
}

// With codebooks of one digit a number: seeds are to be small.
std::string short_sog_meta() {
  std::string meta = sog_parts(3, 1).front().bytes;
  const std::string key = "\"codebook\": [";
  std::string digits;
  for (int k = 0; k < 256; ++k) digits += (k == 0 ? "" : ",") + std::to_string(k % 10);
  for (std::size_t at = meta.find(key); at != std::string::npos; at = meta.find(key, at)) {
    at += key.size();
    meta.replace(at, meta.find(']', at) - at, digits);
  }
  return meta;
}

void make_scene_files(const std::string& corpus) {
  write_file(corpus, "splat/good_three.splat", splat_bytes(3));
  write_file(corpus, "compressed_ply/good_degree_0.ply", compressed_ply_bytes(2, 0, false));
  write_file(corpus, "compressed_ply/good_degree_1.ply", compressed_ply_bytes(2, 1, true));
  for (const std::uint32_t version : {1U, 2U, 3U, 4U}) {
    const std::string name = "spz/good_v" + std::to_string(version);
    write_file(corpus, name + ".spz", spz_bytes(version, 3, 1));
    if (version < 4) write_file(corpus, name + "_bare.spz", bare_spz_bytes(version, 3, 1));
  }
  std::vector<Part> parts = sog_parts(3, 1);
  parts.front().bytes = short_sog_meta();
  write_file(corpus, "sog/good_degree_1.sog", zip_bytes(parts));
  write_file(corpus, "sog_meta/good_degree_1.json", short_sog_meta());
  for (const Part& part : parts) {
    if (part.name == "sh0.webp") write_file(corpus, "sog_picture/good_made.webp", part.bytes);
  }
  write_file(corpus, "streamed_sog/good_one_file.json",
             R"({"version": 1, "lodLevels": 1, "counts": [3], "filenames": ["0_0/meta.json"],
"tree": {"children": [{"lods": {"0": {"file": 0, "offset": 0, "count": 3}}}]}})");
  for (const int compression : {0, 1, 2}) {
    write_file(corpus, "ksplat/good_compression_" + std::to_string(compression) + ".ksplat",
               without_runs(ksplat_bytes(compression, 5, 1)));
  }
  write_file(corpus, "gltf/good_degree_1.glb", glb_bytes(2, 1));
  write_file(corpus, "gltf/good_node.glb",
             glb_bytes(2, 0, R"(, "translation": [1, 2, 3], "rotation": [1, 0, 0, 0])"));
  write_file(corpus, "gltf/good_spz.glb", spz_glb_bytes(spz_bytes(3, 3, 1)));
}

void make_seeds(const std::string& corpus) {
  std::string scratch = (fs::temp_directory_path() / "sgs-seeds-XXXXXX").string();
  if (::mkdtemp(scratch.data()) == nullptr) throw fs::filesystem_error(scratch, {});
  make_datasets(corpus, scratch);
  fs::remove_all(scratch);
  make_pictures(corpus);
  make_scenes(corpus);
  make_scene_files(corpus);
}

}  // namespace
}  // namespace sgs::test

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  sgs::test::make_seeds(argv[1]);
}

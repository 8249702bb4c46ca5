// Names of images as data sets write them, and the files that they mean.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/algorithm/image/photograph_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;

namespace {

std::vector<std::uint8_t> grey_bytes() { return std::vector<std::uint8_t>(4 * 64 * 48, 128); }

// Puts `bytes` as images/shot_NN + extension for every view.
Damage all_images(const std::string& from, const std::string& to, const std::string& bytes) {
  return [=](const std::string& folder) {
    for (int i = 0; i < 10; ++i) {
      const std::string name = "images/shot_0" + std::to_string(i);
      std::filesystem::remove(folder + "/" + name + from);
      write_file(folder, name + to, bytes);
    }
  };
}

}  // namespace

TEST_CASE("image search: back-slashes, cases of extensions, names without one, WebP and TIFF") {
  const std::string png = rgba_png(RgbaImage(64, 48));
  struct Row {
    const char* what;
    WriteDataset write;
    std::vector<Damage> changes;
    const char* name = "shot_03";
  };
  const std::string images = "sparse/0/images.txt";
  for (const Row& row :
       std::vector<Row>{{"transforms.json of Windows",
                         write_transforms,
                         {replace_all("transforms.json", "images/shot", "images\\\\shot")},
                         "images/shot_03"},
                        {"COLMAP of Windows",
                         write_colmap_text,
                         {replace_all(images, "shot_", "day\\shot_"), move_to("images", "was"),
                          move_to("was", "images/day")},
                         "day/shot_03"},
                        {".JPG for .jpg", write_colmap_binary, {all_images(".jpg", ".JPG", png)}},
                        {".Png for .png", write_colmap_text, {all_images(".png", ".Png", png)}},
                        {".jpg for .JPG",
                         write_colmap_text,
                         {replace_all(images, ".png", ".JPG"), all_images(".png", ".jpg", png)}},
                        {"none for .Jpeg", write_cameras_json, {all_images(".png", ".Jpeg", png)}},
                        {"none for .webp",
                         write_cameras_json,
                         {all_images(".png", ".webp", webp_bytes(64, 48, grey_bytes()))}},
                        {".tif",
                         write_colmap_text,
                         {replace_all(images, ".png", ".tif"),
                          all_images(".png", ".tif", tiff_bytes(64, 48, grey_bytes()))}}}) {
    INFO(row.what);
    const ScratchFolder scratch;
    row.write(scratch.path(""), made_scene());
    for (const Damage& change : row.changes) change(scratch.path(""));
    const Dataset dataset = open_dataset(scratch.path(""));
    REQUIRE(dataset.views.size() == 10);
    CHECK(dataset.views[3].name == row.name);
    CHECK(load_view(dataset.views[3]).width == 64);
  }
}

TEST_CASE("image search: the folder images_4 by option, or where it is alone") {
  const std::string small = rgba_png(RgbaImage(16, 12));
  for (const auto& write : {write_colmap_text, write_transforms, write_cameras_json}) {
    const ScratchFolder scratch;
    const std::string folder = scratch.path("set");
    const char* extension = write == write_transforms ? ".jpg" : ".png";
    write(folder, made_scene());
    for (int i = 0; i < 10; ++i) {
      write_file(folder, "images_4/shot_0" + std::to_string(i) + extension, small);
    }
    const Dataset whole = open_dataset(folder);
    CHECK(whole.views[0].camera.width == 64);
    CHECK(whole.notes.empty());
    const auto check_small = [&](const Dataset& dataset) {
      REQUIRE(dataset.views.size() == 10);
      CHECK(dataset.views[3].name == whole.views[3].name);
      CHECK(dataset.views[3].camera.width == 16);
      CHECK(dataset.views[3].camera.height == 12);
      CHECK(dataset.views[3].camera.focal_x == 15);
      REQUIRE(dataset.notes.size() == 1);
      CHECK(dataset.notes[0] == std::pair<std::string, std::string>{"images from", "images_4"});
    };
    check_small(open_dataset(folder, {1, "", "images_4"}));
    std::filesystem::remove_all(folder + "/images");
    check_small(open_dataset(folder));
    std::filesystem::create_directory(folder + "/images_8");
    CHECK_THAT(input_error_of([&] { open_dataset(folder); }),
               Contains("no folder images in ") &&
                   Contains("set, but images_4 and images_8, expected --images"));
    check_small(open_dataset(folder, {1, "", "images_4"}));
    CHECK_THAT(input_error_of([&] {
                 open_dataset(folder, {1, "", "images_2"});
               }),
               Contains("set/images_2") || Contains("images_2/shot_00"));
  }
  const ScratchFolder nsvf;
  write_nsvf_matrix(nsvf.path(""), made_scene());
  CHECK_THAT(
      input_error_of([&] {
        open_dataset(nsvf.path(""), {1, "", "images_2"});
      }),
      Contains("--images images_2: got the image '0_0000', expected one in a folder images"));
}

TEST_CASE("image search: masks, of the image's size and smaller, through lens and downscale") {
  const ScratchFolder scratch;
  const std::string folder = scratch.path("set");
  write_transforms(folder, made_scene());
  replace_all("transforms.json", "\"file_path\"",
              "\"mask_path\": \"masks/m.png\", \"file_path\"")(folder);
  // The left quarter is black, the rest is the darkest that is not.
  const auto mask = [&](int width, int height) {
    RgbaImage image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        image.at(x, y) = glm::vec4(glm::vec3(x < width / 4 ? 0.0F : 1 / 255.0F), 1);
      }
    }
    write_file(folder, "masks/m.png", rgba_png(image));
  };
  const auto check_columns = [&](const Dataset& dataset, double downscale, int masked) {
    const std::vector<std::uint8_t> counts = load_mask(dataset.views[2], downscale);
    const Camera camera = downscaled_camera(dataset.views[2], downscale);
    REQUIRE(counts.size() == static_cast<std::size_t>(camera.width) * camera.height);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      REQUIRE(counts[i] == (static_cast<int>(i) % camera.width < masked ? 0 : 1));
    }
  };
  mask(64, 48);
  check_columns(open_dataset(folder), 1, 16);
  check_columns(open_dataset(folder), 2, 8);
  check_columns(open_dataset(folder), 3, 6);  // the sixth has a third of a masked one
  mask(16, 12);
  check_columns(open_dataset(folder), 1, 16);
  const Dataset dataset = open_dataset(folder);
  REQUIRE(dataset.notes.size() == 1);
  CHECK(dataset.notes[0].first == "masks");
  CHECK_THAT(dataset.notes[0].second, Contains("of 10 views"));
  // Pixels stay where they are, wherever the principal point is.
  replace("transforms.json", "\"cx\": 32", "\"cx\": 36")(folder);
  check_columns(open_dataset(folder), 1, 16);
  replace("transforms.json", "\"cx\": 36", "\"cx\": 32")(folder);
  replace("transforms.json", "\"k1\": 0.0", "\"k1\": -0.1")(folder);
  const Dataset through_lens = open_dataset(folder);
  const std::vector<std::uint8_t> counts = load_mask(through_lens.views[2]);
  const int width = through_lens.views[2].camera.width;
  // In the middle row the border, 16 px of the file from the middle, is 16 (1 + 0.1 r^2) px from
  // it.
  const int row = through_lens.views[2].camera.height / 2;
  const double border = 0.5 * width - 16 * (1 + 0.1 * std::pow(16 / 60.0, 2));
  for (int x = 0; x < width; ++x) {
    if (std::abs(x + 0.5 - border) < 1.5) continue;
    CHECK(counts[static_cast<std::size_t>(row) * width + x] == (x + 0.5 < border ? 0 : 1));
  }

  write_file(folder, "masks/m.png", rgba_png(RgbaImage(64, 48)));
  CHECK_THAT(input_error_of([&] { load_mask(open_dataset(folder).views[0]); }),
             Contains("m.png: got a mask that leaves no pixel"));
  mask(48, 48);
  CHECK_THAT(input_error_of([&] { load_mask(open_dataset(folder).views[0]); }),
             Contains("m.png: got a mask of 48x48 px, expected the shape of "));
  std::filesystem::remove(folder + "/masks/m.png");
  CHECK_THAT(input_error_of([&] { open_dataset(folder); }),
             Contains("frame 0: no image 'masks/m.png'"));
  write_nsvf_matrix(scratch.path("plain"), made_scene());
  CHECK(load_mask(open_dataset(scratch.path("plain")).views[0]).empty());
}

// Data sets that cannot be used: one line with file, place, what is there, what was expected.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

// A matrix with `number` on its diagonal in place of the first view's for testing.
Damage first_matrix(const std::string& number) {
  return replace("transforms_test.json", "[[",
                 "[[" + number + ",0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], \"was\": [[");
}

}  // namespace

TEST_CASE("dataset refuses: folders that are no data set, or two") {
  const ScratchFolder scratch;
  CHECK_THAT(input_error_of([&] { open_dataset(scratch.path("none")); }),
             Contains("none: no such folder"));
  const std::string empty = input_error_of([&] { open_dataset(scratch.path("")); });
  for (const char* looked_for :
       {"holds no data set, expected one of: ", "sparse/0/cameras.bin", "transforms_train.json",
        "transforms.json", "cameras.json", "intrinsics.txt with pose and rgb"}) {
    CHECK_THAT(empty, Contains(looked_for));
  }
  check_refused(
      {{write_colmap_text,
        with("cameras.json", "[]"),
        {"set: holds sparse/0/cameras.bin or .txt and cameras.json, expected one of them, or "
         "--layout colmap or cameras"}},
       {write_transforms,
        with("transforms_train.json", "{}"),
        {"holds transforms_train.json and transforms.json, expected one"}}});
}

TEST_CASE("dataset refuses: cameras without images, images of another shape, damaged images") {
  check_refused({
      {write_colmap_binary,
       without("images/shot_03.jpg"),
       {"images.bin: image 6: no image 'shot_03.jpg' in ", "/set/images, expected it there"}},
      {write_colmap_text,
       without("images/shot_03.png"),
       {"images.txt: line 8: no image 'shot_03.png'"}},
      {write_nerf_synthetic,
       without("train/shot_05.png"),
       {"transforms_train.json: frame 2: no image './train/shot_05'"}},
      {write_transforms, without("images"), {"transforms.json: frame 0: no image"}},
      {write_cameras_json,
       without("images/shot_09.png"),
       {"cameras.json: camera 9: no image 'shot_09' in ", "/set/images or ", ".jpg"}},
      {write_nsvf_matrix, without("rgb/0_0002.png"), {"pose/0_0002.txt: no image '0_0002'"}},
      {write_cameras_json,
       with("shot_09.jpg", "x"),
       {"camera 9: image 'shot_09': got ", "images/shot_09.png and ", "shot_09.jpg, expected one"}},
      {write_cameras_json,
       resize("images/shot_09.png", 64, 50),
       {"camera 9: ", "shot_09.png is 64x50 px, expected 64x48"}},
      {write_cameras_json, resize("images/shot_09.png", 48, 64), {"is 48x64 px, expected 64x48"}},
      {write_colmap_text, resize("images/shot_09.png", 31, 12), {"is 31x12 px, expected 64x48"}},
      {write_nsvf_focal, resize("rgb/0_0001.png", 64, 40), {"is 64x40 px, expected 64x48"}},
      {write_nerf_synthetic,
       resize("train/shot_05.png", 64, 40),
       {"transforms_train.json: frame 2: ", "is 64x40 px, expected the shape of ", "64x48 px"}},
      {write_transforms, resize("images/shot_01.jpg", 64, 40), {"is 64x40 px, expected 64x48"}},
      {write_cameras_json, with("images/shot_01.png", ""), {"shot_01.png: neither begins as"}},
      {write_cameras_json,
       with("images/shot_01.png", "\x89PNG\r\n\x1a\n1234"),
       {"shot_01.png: ", "expected a PNG image"}},
      {write_transforms,
       with("images/shot_01.jpg", "\xff\xd8\xff"),
       {"shot_01.jpg: ", "expected a JPEG image"}},
  });
}

TEST_CASE("dataset refuses: cameras that see nothing, poses that are none") {
  check_refused({
      {write_nerf_synthetic,
       replace("transforms_train.json", "\"camera_angle_x\": ", "\"camera_angle_x\": 9"),
       {"transforms_train.json: frame 0: camera_angle_x: got 9", "between 0 and pi"}},
      {write_nerf_synthetic,
       replace("transforms_train.json", "camera_angle_x", "angle"),
       {"frame 0: fl_x: got nothing, expected it, or camera_angle_x"}},
      {write_nerf_synthetic,
       first_matrix("null"),
       {"transforms_test.json: frame 0: transform_matrix[0][0]: got null, expected a finite"}},
      {write_nerf_synthetic,
       replace("transforms_test.json", "[0,0,0,1]", "[0,0,1,1]"),
       {"frame 0: transform_matrix: got 1 as number 2 of the last row, expected 0 0 0 1"}},
      {write_nerf_synthetic,
       replace("transforms_test.json", "[0,0,0,1]", "[0,0,0]"),
       {"frame 0: transform_matrix[3]: got [0,0,0], expected 4 numbers"}},
      {write_nerf_synthetic,
       replace("transforms_test.json", "[0,0,0,1]", "[0,0,0,\"x\"]"),
       {"frame 0: transform_matrix[3][3]: got \"x\""}},
      {write_nerf_synthetic,
       first_matrix("0.5"),
       {"frame 0: transform_matrix: got axes that are off by ", "orthonormal"}},
      {write_transforms,
       replace("transforms.json", "\"fl_x\": 60", "\"fl_x\": 0"),
       {"transforms.json: frame 0: focal length: got 0, expected px above 0"}},
      {write_transforms,
       replace("transforms.json", "\"fl_x\": 60", "\"fl_x\": -60"),
       {"focal length: got -60"}},
      {write_transforms,
       replace("transforms.json", "\"fl_x\": 60", "\"fl_x\": 1e300"),
       {"focal length: got 1e+300"}},
      {write_transforms,
       replace("transforms.json", "\"cx\": 32", "\"cx\": 65"),
       {"frame 0: principal point: got x at 65 px of 64, expected it in the picture"}},
      {write_transforms,
       replace("transforms.json", "\"w\": 64", "\"w\": 0.5"),
       {"frame 0: w: got 0.5, expected a whole number of px"}},
      {write_transforms,
       replace("transforms.json", "file_path", "file"),
       {"frame 0: file_path: got nothing"}},
      {write_cameras_json,
       replace("cameras.json", "\"fx\": 60", "\"fx\": 0"),
       {"cameras.json: camera 0: focal length: got 0"}},
      {write_nsvf_matrix,
       with("pose/0_0000.txt", "1 0 0 0 0 1 0 0 0 0 1 nan 0 0 0 1"),
       {"pose/0_0000.txt: number: got 'nan', expected a finite number"}},
      {write_nsvf_matrix,
       with("pose/0_0000.txt", "1 0 0 0 0 1 0 0 0 0 1 0"),
       {"pose/0_0000.txt: got 12 numbers, expected 4x4"}},
      {write_nsvf_matrix,
       with("pose/0_0000.txt", "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"),
       {"pose/0_0000.txt: pose: got a mirrored frame"}},
      {write_nsvf_matrix,
       with("pose/0_0000.txt", "1 0 0 1e19 0 1 0 0 0 0 1 0 0 0 0 1"),
       {"position: got (1e+19, 0, 0), expected finite numbers of at most 1e+18"}},
      {write_nsvf_matrix,
       with("pose/0_0000.txt", std::string(70000, ' ')),
       {"got 70000 bytes, expected a matrix"}},
      {write_nsvf_matrix,
       with("intrinsics.txt", "60 0 32 0 60"),
       {"intrinsics.txt: got 5 numbers, expected 9 or 16 (a matrix) or 11"}},
      {write_nsvf_matrix, with("intrinsics.txt", "0 0 32 0 60 24 0 0 1"), {"focal length: got 0"}},
      {write_nsvf_matrix,
       with("intrinsics.txt", "60 3 32 0 60 24 0 0 1"),
       {"intrinsics.txt: got a skew of 3"}},
      {write_nsvf_focal,
       replace("intrinsics.txt", "48 64", "48 0"),
       {"a height of 48 and a width of 0"}},
      {write_nsvf_focal,
       replace("intrinsics.txt", "48 64", "0 64"),
       {"a height of 0 and a width of 64"}},
      {write_nsvf_focal,  // a pixel is a size
       replace("intrinsics.txt", "48 64", "1 1"),
       {"is 64x48 px, expected 1x1"}},
      {write_nsvf_matrix, with("bbox.txt", "1 1 1 0 0 0"), {"bbox.txt: got 6 numbers"}},
  });
}

// A file of points beside transforms.json that names it.
Damage points(const std::string& file) {
  return [=](const std::string& folder) {
    replace("transforms.json", "{", "{\"ply_file_path\": \"pc.ply\", ")(folder);
    write_file(folder, "pc.ply", file);
  };
}

TEST_CASE("dataset refuses: lists of names without a frame, start points that are none") {
  const auto list = [](const std::string& entry) {
    return replace("transforms.json", "{", "{" + entry + ", ");
  };
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const std::string rest =
      "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n";
  const std::string blue = "property uchar blue\nend_header\n";
  check_refused({
      {write_transforms,
       list("\"test_filenames\": [\"images/shot_01.jpg\", \"./images/typo.jpg\"]"),
       {"transforms.json: test_filenames[1]: got \"./images/typo.jpg\", expected paths of images "
        "as "
        "frames have them"}},
      {write_transforms,
       list("\"val_filenames\": [\"typo.jpg\"]"),
       {"transforms.json: val_filenames[0]: got \"typo.jpg\""}},
      {write_transforms,
       list("\"train_filenames\": [7]"),
       {"transforms.json: train_filenames[0]: got 7"}},
      {write_transforms,
       list("\"ply_file_path\": \"none.ply\""),
       {"set/none.ply: cannot be opened"}},
      {write_transforms,
       list("\"ply_file_path\": 1"),
       {"transforms.json: ply_file_path: got 1, expected a text"}},
      {write_transforms, points("x"), {"set/pc.ply: "}},
      {write_transforms,
       points(head + rest + blue + "10.25 20.5 3.25 4 5"),
       {"pc.ply: ends, expected blue"}},
      {write_transforms,
       points(head + rest + blue + "1 2 nan 4 5 6\n"),
       {"pc.ply: z: got 'nan', expected a finite number"}},
      {write_transforms,
       points(head + rest + blue + "1 2 1e30 4 5 6\n"),
       {"pc.ply: vertex 0: position: got 1e+30"}},
      {write_transforms,
       points(head + rest + blue + "1 2 3 4 256 6\n"),
       {"pc.ply: vertex 0: green: got 256, expected 0 to 255"}},
      {write_transforms,
       points(head + rest + "end_header\n1 2 3 4 5\n"),
       {"pc.ply: element vertex: blue: got nothing, expected a property of uchar"}},
      {write_transforms,
       points(head + rest + "property float blue\nend_header\n1 2 3 4 5 6\n"),
       {"pc.ply: element vertex: blue: got another type, expected a property of uchar"}},
      {write_transforms,
       points("ply\nformat ascii 1.0\nelement face 0\nproperty int x\nend_header\n"),
       {"pc.ply: got the element face first, expected vertex"}},
      {write_transforms,
       points(head + "property list uchar int y\n" + "end_header\n1 1 2\n"),
       {"pc.ply: element vertex: got a list, expected numbers alone"}},
      {write_transforms,
       points("ply\nformat binary_little_endian 1.0\nelement vertex 99\nproperty float x\n" + rest +
              blue + "abc"),
       {"pc.ply: "}},
  });
}

TEST_CASE("dataset refuses: empty sets, names twice, splits that are half there") {
  check_refused({
      {write_cameras_json,
       with("cameras.json", "[]"),
       {"set: holds 0 views (cameras.json), none to train from"}},
      {write_nerf_synthetic,
       with("transforms_train.json", "{\"frames\": []}"),
       {"holds 3 views (NeRF synthetic), none to train from"}},
      {write_nerf_synthetic,
       with("transforms_train.json", "{\"frames\": 3}"),
       {"transforms_train.json: got no frames"}},
      {write_nsvf_matrix,
       [](const std::string& folder) {
         fs::remove_all(folder + "/pose");
         fs::create_directory(folder + "/pose");
       },
       {"holds 0 views (NSVF)"}},
      {write_colmap_text, with("sparse/0/images.txt", "# nothing\n"), {"holds 0 views (COLMAP)"}},
      {write_colmap_text,
       replace("sparse/0/images.txt", "shot_04", "shot_03"),
       {"images.txt: line 10: name 'shot_03' a second time, after ", "images.txt: line 8"}},
      {write_cameras_json,
       replace("cameras.json", "shot_04", "shot_03"),
       {"cameras.json: camera 4: name 'shot_03' a second time, after ", "camera 3"}},
      {write_nerf_synthetic,
       replace("transforms_train.json", "./train/shot_04", "./train/../train/shot_05"),
       {"frame 2: name 'train/shot_05' a second time, after ", "frame 1"}},
      {write_nsvf_matrix,
       with("pose/plain.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"),
       {"set/pose: got names with and without 0_, 1_ or 2_"}},
  });
}

TEST_CASE("dataset refuses: an image that changed or was cut since, factors below 1") {
  const ScratchFolder scratch;
  const std::string folder = scratch.path("set");
  write_cameras_json(folder, made_scene());
  const Dataset dataset = open_dataset(folder);
  const DatasetView& view = dataset.views[2];
  for (const double downscale : {0.0, 0.99, -2.0, kNan, kInfinity}) {
    CHECK_THAT(input_error_of([&] { load_view(view, downscale); }),
               Contains("view 'shot_02': downscale "));
    CHECK_THAT(input_error_of([&] {
                 open_dataset(folder, {downscale, "", ""});
               }),
               Contains("view 'shot_00': downscale "));
  }
  const std::string whole = bytes_of(view.image_path);
  write_file(folder, "images/shot_02.png", whole.substr(0, whole.size() / 2));
  CHECK_THAT(input_error_of([&] { load_view(view); }), Contains("shot_02.png: "));
  write_file(folder, "images/shot_02.png", rgba_png(RgbaImage(32, 24)));
  CHECK_THAT(input_error_of([&] { load_view(view); }),
             Contains("shot_02.png: got 32x24 px, expected 64x48 as when"));
}

// COLMAP's models that cannot be used: one line with file, place, what is there, what was expected.
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "algorithm/dataset/colmap_model.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;

namespace {

// Overwrites the bytes of folder/name from `at` on.
template <class Value>
Damage overwrite(const std::string& name, std::size_t at, Value value) {
  return [=](const std::string& folder) {
    std::string bytes = bytes_of(folder + "/" + name);
    REQUIRE(at + sizeof(Value) <= bytes.size());
    std::memcpy(&bytes[at], &value, sizeof(Value));
    write_file(folder, name, bytes);
  };
}

}  // namespace

TEST_CASE("dataset refuses: COLMAP's models with distortion, ids, text that is none") {
  const std::size_t kModel = 8 + 4, kWidth = kModel + 4, kFocal = kWidth + 16;
  const std::size_t kQuaternion = 8 + 4, kTranslation = kQuaternion + 32;
  const std::size_t kCameraId = kTranslation + 24;
  check_refused({
      {write_colmap_binary,  // of OPENCV there are eight numbers
       overwrite("sparse/0/cameras.bin", kModel, std::int32_t{4}),
       {"cameras.bin: byte 64: the file ends, expected a camera's parameters"}},
      {write_colmap_binary,
       overwrite("sparse/0/cameras.bin", kModel, std::int32_t{-5}),
       {"got the camera model number -5"}},
      {write_colmap_binary,
       overwrite("sparse/0/cameras.bin", kModel, std::int32_t{0}),
       {"cameras.bin: byte ", "got 8 bytes after the last record"}},
      {write_colmap_binary,
       overwrite("sparse/0/cameras.bin", kWidth, std::uint64_t{1} << 40),
       {"camera 0: size: got 1099511627776x48"}},
      {write_colmap_binary,
       overwrite("sparse/0/cameras.bin", kFocal, 0.0),
       {"images.bin: image 9: focal length: got 0"}},
      {write_colmap_binary,
       overwrite("sparse/0/cameras.bin", kFocal, kNan),
       {"cameras.bin: camera 0: parameter: got nan"}},
      {write_colmap_binary,
       overwrite("sparse/0/images.bin", kCameraId, std::uint32_t{8}),
       {"images.bin: image 0: camera id 8: no such camera"}},
      {write_colmap_binary,
       overwrite("sparse/0/images.bin", kQuaternion, kInfinity),
       {"images.bin: image 0: pose: got inf, expected finite numbers"}},
      {write_colmap_binary,
       overwrite("sparse/0/images.bin", kTranslation, kNan),
       {"images.bin: image 0: pose: got nan"}},
      {write_colmap_binary,
       overwrite("sparse/0/points3D.bin", 16, kNan),
       {"points3D.bin: point 0: position: got nan"}},
      {write_colmap_binary, without("sparse/0/points3D.bin"), {"points3D.bin: cannot be opened"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "SIMPLE_PINHOLE", "SIMPLE_RADIAL"),
       {"cameras.txt: line 2: ends, expected a camera's parameter"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "3 SIMPLE", "3 SIMPLE_PINHOLE 64 48 60 32 24\n3 SIMPLE"),
       {"cameras.txt: line 3: camera id 3 a second time"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "PINHOLE 64", "PINHOLE -64"),
       {"cameras.txt: line 2: a width: got '-64'"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "PINHOLE 64", "PINHOLE 0"),
       {"cameras.txt: line 2: size: got 0x48"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "24\n", "24 0.1\n"),
       {"cameras.txt: line 2: got '0.1', expected the end"}},
      {write_colmap_text,
       replace("sparse/0/cameras.txt", " 24\n", "\n"),
       {"cameras.txt: line 2: ends, expected a camera's parameter"}},
      {write_colmap_text,
       with("sparse/0/images.txt", "1 0 0 0 0 1 2 3 3 shot_00.png\n\n"),
       {"images.txt: line 1: pose: got a quaternion of length 0"}},
      {write_colmap_text,
       with("sparse/0/images.txt", "1 1 0 0 0 1 2 3 3\n\n"),
       {"images.txt: line 1: ends, expected an image's name"}},
      {write_colmap_text,
       with("sparse/0/images.txt", "1 1 0 0 0 1 2 x 3 a.png\n\n"),
       {"images.txt: line 1: a pose: got 'x'"}},
      {write_colmap_text,
       with("sparse/0/points3D.txt", "1 0 0 0 255 256 0 1\n"),
       {"points3D.txt: line 1: a colour: got '256', expected a whole number from 0 to 255"}},
      {write_colmap_text,
       with("sparse/0/points3D.txt", "1 0 0 0 255 25 0 x\n"),
       {"points3D.txt: line 1: an error: got 'x', expected a number"}},
      {write_colmap_text,
       with("sparse/0/points3D.txt", "1 0 0 0 255 25 0 0.5 1 0 2\n"),
       {"points3D.txt: line 1: ends, expected a point's number of a track"}},
      {write_colmap_text,
       replace("sparse/0/images.txt", "1.5 2.5 -1\n", "1.5 2.5 -1 7\n"),
       {"images.txt: line 3: got 4 fields, expected the points of the image before it, 3 numbers "
        "each, or another image"}},
      {write_colmap_text,
       replace("sparse/0/images.txt", "1.5 2.5 -1\n", "1.5 a.jpg -1\n"),
       {"images.txt: line 3: got 3 fields"}},
  });
}

TEST_CASE("dataset refuses: COLMAP's binary files cut at every byte, and counts beyond them") {
  const ScratchFolder scratch;
  write_colmap_binary(scratch.path("set"), made_scene());
  const std::string folder = scratch.path("set/sparse/0");
  const auto read_all = [&] {
    const ColmapModel model = read_colmap_binary(folder);
    read_colmap_points_binary(folder);
    return model;
  };
  CHECK(read_all().images.size() == 10);
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const std::string path = folder + "/" + name;
    const std::string whole = bytes_of(path);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      INFO(name << " " << size);
      write_file(folder, name, whole.substr(0, size));
      CHECK_THAT(input_error_of(read_all), Contains(path + ": byte "));
    }
    for (const std::uint64_t count :
         {std::uint64_t{11}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
      std::string bytes = whole;
      std::memcpy(bytes.data(), &count, sizeof(count));
      write_file(folder, name, bytes);
      CHECK_THAT(input_error_of(read_all), Contains(path + ": byte "));
    }
    write_file(folder, name, whole + "x");
    CHECK_THAT(input_error_of(read_all), Contains("got 1 bytes after the last record"));
    write_file(folder, name, whole);
  }
  // The counts inside of records: points of an image, images of a point.
  const std::size_t kPoints2d = 8 + 4 + 56 + 4 + std::strlen("shot_09.jpg") + 1;
  const std::size_t kTrack = 8 + 8 + 24 + 3 + 8;
  for (const auto& [name, at] : {std::pair("images.bin", kPoints2d), {"points3D.bin", kTrack}}) {
    const std::string whole = bytes_of(folder + "/" + name);
    overwrite(name, at, ~std::uint64_t{0} / 16)(folder);
    CHECK_THAT(input_error_of(read_all), Contains("expected as many as "));
    write_file(folder, name, whole);
  }
}

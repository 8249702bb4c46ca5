// image_formats.h: the kinds of OpenEXR files that others write.
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <half.h>

#include <catch2/catch.hpp>
#include <vector>

#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

// Writes a 2x3 picture whose data window begins at (10, -20), one plane a channel; the value of
// channel number c at (x, y) is 100 c + 10 y + x.
void write_planes(const std::string& path, const std::vector<std::string>& names) {
  const Imath::Box2i window({10, -20}, {11, -18});
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
  std::vector<std::vector<half>> planes(names.size());
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::HALF));
    for (int i = 0; i < 6; ++i) {
      planes[c].push_back(
          half(static_cast<float>(100 * c) + static_cast<float>(10 * (i / 2) + i % 2)));
    }
    frame.insert(names[c], Imf::Slice::Make(Imf::HALF, planes[c].data(), window));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(3);
}

}  // namespace

TEST_CASE("exr: half channels in any order, a data window off the origin, others ignored") {
  const test::ScratchFolder scratch;
  write_planes(scratch.path("a.exr"), {"B", "G", "R", "A", "depth.Z"});
  const Image image = read_exr(scratch.path("a.exr"));
  REQUIRE(image.width == 2);
  REQUIRE(image.height == 3);
  CHECK(image.at(0, 0) == glm::vec3(200, 100, 0));
  CHECK(image.at(1, 2) == glm::vec3(221, 121, 21));
}

TEST_CASE("exr refuses: channels that are missing, by what is there") {
  const test::ScratchFolder scratch;
  write_planes(scratch.path("a.exr"), {"R", "G", "A"});
  CHECK_THAT(test::input_error_of([&] { read_exr(scratch.path("a.exr")); }),
             Contains("got the channels A G R, expected R, G and B"));
}

TEST_CASE("exr refuses: other files, and windows beyond 65,535 px") {
  const test::ScratchFolder scratch;
  for (const char* bytes : {"", "x", "not an exr file at all"}) {
    const std::string path = scratch.write("a.exr", bytes);
    CHECK_THAT(test::input_error_of([&] { read_exr(path); }),
               Contains("expected an OpenEXR image"));
  }
  write_image(scratch.path("b.exr"), Image(4, 4));
  std::string forged = test::bytes_of(scratch.path("b.exr"));
  const std::string name("dataWindow\0box2i\0", 17);
  const std::size_t at = forged.find(name);
  REQUIRE(at != std::string::npos);
  // After the name and the length: xMin, yMin, xMax, yMax. One billion each way.
  const std::string billion("\x00\xca\x9a\x3b", 4);
  forged.replace(at + name.size() + 4 + 8, 8, billion + billion);
  const std::string path = scratch.write("c.exr", forged);
  CHECK_THAT(test::input_error_of([&] { read_exr(path); }), Contains("c.exr"));
}

TEST_CASE("exr refuses: an attribute beyond the end of the file, before there is room for it") {
  const test::ScratchFolder scratch;
  write_image(scratch.path("a.exr"), Image(4, 4));
  std::string bytes = test::bytes_of(scratch.path("a.exr"));
  const std::string compression("compression\0compression\0", 24);
  const std::size_t at = bytes.find(compression) + compression.size();
  REQUIRE(at < bytes.size());
  bytes.replace(at, 4, std::string("\x00\x00\x00\x78", 4));
  CHECK_THAT(test::input_error_of([&] { read_exr(scratch.write("b.exr", bytes)); }),
             Contains("attribute compression: got 2013265920 bytes, expected at most the"));
}

// image_formats.h: bytes by hand.
#include <catch2/catch.hpp>

#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

// 1.0f and -2.0f.
const std::string kOneLittle("\x00\x00\x80\x3f", 4), kOneBig("\x3f\x80\x00\x00", 4);
const std::string kMinusTwoLittle("\x00\x00\x00\xc0", 4), kMinusTwoBig("\xc0\x00\x00\x00", 4);

}  // namespace

TEST_CASE("pfm: little-endian, bottom row first") {
  const test::ScratchFolder scratch;
  Image image(1, 2);
  image.at(0, 0) = glm::vec3(1, -2, 1);   // top
  image.at(0, 1) = glm::vec3(-2, -2, 1);  // bottom
  write_image(scratch.path("a.pfm"), image);
  CHECK(test::bytes_of(scratch.path("a.pfm")) == "PF\n1 2\n-1.0\n" + kMinusTwoLittle +
                                                     kMinusTwoLittle + kOneLittle + kOneLittle +
                                                     kMinusTwoLittle + kOneLittle);
}

TEST_CASE("pfm: either byte order, colour or grey, scaled") {
  const test::ScratchFolder scratch;
  const Image big = read_pfm(scratch.write("a", "PF 1 1 1.0\n" + kOneBig + kMinusTwoBig + kOneBig));
  CHECK(big.at(0, 0) == glm::vec3(1, -2, 1));
  const Image grey = read_pfm(scratch.write("b", "Pf\n1 2\n-1\n" + kOneLittle + kMinusTwoLittle));
  CHECK(grey.at(0, 0) == glm::vec3(-2));
  CHECK(grey.at(0, 1) == glm::vec3(1));
  const Image scaled = read_pfm(scratch.write("c", "Pf\n1 1\n-2.5\n" + kMinusTwoLittle));
  CHECK(scaled.at(0, 0) == glm::vec3(-5));
  // The first value begins with a byte that is a blank.
  const Image blank =
      read_pfm(scratch.write("d", std::string("Pf\n1 1\n-1\n\x0a\x20\x80\x3f", 14)));
  CHECK(blank.at(0, 0).x > 1.0f);
}

TEST_CASE("pfm refuses: other magic words, sizes, scales") {
  const test::ScratchFolder scratch;
  const std::string pixel = kOneLittle + kOneLittle + kOneLittle;
  for (const char* header :
       {"", "P6\n1 1\n255\n", "PF\n", "PF\n0 1\n-1\n", "PF\n1 -1\n-1\n", "PF\na 1\n-1\n",
        "PF\n1 1\n0\n", "PF\n1 1\nnan\n", "PF\n1 1 -1x", "PF\n99999999999999999999 1\n-1\n"}) {
    CAPTURE(header);
    const std::string path = scratch.write("a.pfm", header + pixel);
    CHECK_THAT(test::input_error_of([&] { read_pfm(path); }), Contains("not a PFM header"));
  }
}

TEST_CASE("pfm refuses: files that are shorter or longer than they say") {
  const test::ScratchFolder scratch;
  const std::string pixel = kOneLittle + kOneLittle + kOneLittle;
  for (const char* size :
       {"1 1", "3 1", "1 3", "2147483647 2147483647", "4294967297 1", "9223372036854775807 2"}) {
    const std::string path =
        scratch.write("a.pfm", std::string("PF\n") + size + "\n-1\n" + pixel + pixel);
    CHECK_THAT(test::input_error_of([&] { read_pfm(path); }), Contains("got 24 bytes, expected"));
  }
}

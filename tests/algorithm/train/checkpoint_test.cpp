// Checkpoints, and files that are none though their checksum is right.
#include "algorithm/train/checkpoint.h"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Contains;

constexpr std::size_t kChecksumAt = 14, kBodyAt = 18;

std::string with_checksum(std::string bytes) {
  const auto crc = static_cast<std::uint32_t>(crc32_z(
      0, reinterpret_cast<const unsigned char*>(bytes.data()) + kBodyAt, bytes.size() - kBodyAt));
  std::memcpy(bytes.data() + kChecksumAt, &crc, sizeof crc);
  return bytes;
}

struct Written {
  ScratchFolder scratch;
  Checkpoint checkpoint{"train d",          "--rate 1", "digest",
                        "step,loss\n1,2\n", 2.5,        std::string("a\0b", 3)};
  std::string bytes;

  Written() {
    write_checkpoint(scratch.path("c"), checkpoint);
    bytes = bytes_of(scratch.path("c"));
  }
};

TEST_CASE("checkpoint: what was written comes back") {
  const Written written;
  REQUIRE(with_checksum(written.bytes) == written.bytes);
  const Checkpoint back = read_checkpoint(written.scratch.path("c"));
  CHECK(back.work == written.checkpoint.work);
  CHECK(back.pace == written.checkpoint.pace);
  CHECK(back.contents == written.checkpoint.contents);
  CHECK(back.log == written.checkpoint.log);
  CHECK(back.seconds == written.checkpoint.seconds);
  CHECK(back.state == written.checkpoint.state);
}

TEST_CASE(
    "checkpoint: cut, longer, or with a length beyond its end: refused whatever the checksum") {
  const Written written;
  const auto refusal = [&](const std::string& bytes) {
    const std::string path = written.scratch.write("d", bytes);
    return input_error_of([&] { read_checkpoint(path); });
  };
  for (std::size_t size = 0; size < written.bytes.size(); ++size) {
    const std::string cut = written.bytes.substr(0, size);
    refusal(cut);
    if (size >= kBodyAt) CHECK_THAT(refusal(with_checksum(cut)), Contains("bytes are left"));
  }
  CHECK_THAT(refusal(with_checksum(written.bytes + "x")), Contains("1 bytes are left of it"));
  // Of the first text; found by fuzzing, as room that was asked for.
  for (const std::uint64_t length :
       {std::uint64_t{1} << 20, std::uint64_t{1} << 50, ~std::uint64_t{0}}) {
    std::string bytes = written.bytes;
    std::memcpy(bytes.data() + kBodyAt + 1, &length, sizeof length);
    CHECK_THAT(refusal(with_checksum(bytes)), Contains("expected " + std::to_string(length)));
  }
}

}  // namespace
}  // namespace sgs::test

// Request streams to the bit, and request traces read without mercy.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "algorithm/files/input_error.h"
#include "testbench/dram/request_generator.h"

namespace sgs {
namespace {

TEST_CASE("streams: first draw, first random address, and hashes of a million requests") {
  std::uint64_t state = 88172645463325252u;
  CHECK(xorshift64star(state) == 0xe6a7a1ea317bcf2bu);
  StreamSpec spec;
  CHECK(RequestGenerator(spec).next().address == 0x8c5ef20);
  spec.write_percent = 30;
  spec.request_bytes = 32;
  CHECK(stream_hash(spec, 1000000) == 0xa8544ce9a493249bu);
  spec.request_bytes = 64;
  CHECK(stream_hash(spec, 1000000) == 0x8537b367addf27bdu);
  RequestGenerator generator(spec);
  std::uint64_t writes = 0;
  for (int i = 0; i < 1000000; ++i) writes += generator.next().write;
  CHECK(writes == 299680);
}

TEST_CASE("streams: sequential wraps, strides move on when they come round") {
  StreamSpec spec;
  spec.pattern = Pattern::kSequential;
  spec.span_bytes = 128;
  RequestGenerator sequential(spec);
  for (const std::uint64_t expected : {0u, 32u, 64u, 96u, 0u})
    CHECK(sequential.next().address == expected);
  spec.pattern = Pattern::kStride;
  spec.stride_bytes = 64;
  RequestGenerator stride(spec);
  for (const std::uint64_t expected : {0u, 64u, 32u, 96u, 0u})
    CHECK(stride.next().address == expected);
}

class RequestFile {
 public:
  explicit RequestFile(const std::string& text)
      : path_(std::string(SGS_BINARY_DIR) + "/requests_" + std::to_string(getpid()) + "_" +
              std::to_string(made_++)) {
    std::ofstream(path_) << text;
  }
  ~RequestFile() { std::remove(path_.c_str()); }
  std::string refusal() const {
    try {
      read_request_trace(path_);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "accepted";
  }
  const std::string& path() const { return path_; }

 private:
  static inline int made_ = 0;
  std::string path_;
};

TEST_CASE("request trace: addresses, directions, times, comments") {
  const RequestFile file("# a comment\n0x40 R\n128 W 10.5\n\n192 R 10.5\n");
  const auto requests = read_request_trace(file.path());
  REQUIRE(requests.size() == 3);
  CHECK(requests[0].address == 64);
  CHECK_FALSE(requests[0].write);
  CHECK(requests[1].write);
  CHECK(requests[1].not_before_ns == 10.5);
}

TEST_CASE("request trace: what is written reads back") {
  const RequestFile file("");
  OutputFile output(file.path());
  RequestTraceWriter writer(output);
  writer.add({0x7fffffc0, true, 1234567.0625, 256});
  writer.add({64, false, 1234568.0, 20});
  output.commit();
  const auto requests = read_request_trace(file.path());
  REQUIRE(requests.size() == 2);
  CHECK(requests[0].address == 0x7fffffc0);
  CHECK(requests[0].write);
  CHECK(requests[0].not_before_ns == 1234567.0625);
  CHECK(requests[0].bytes == 256);
  CHECK(requests[1].bytes == 20);
}

TEST_CASE("request trace: bad lines are refused with their number") {
  CHECK(RequestFile("0 R\n0 X\n").refusal() ==
        ": line 2: got '0 X', expected ADDRESS R|W [NANOSECONDS [BYTES]]");
  CHECK(RequestFile("-5 R\n").refusal().find(": line 1: got '-5 R'") == 0);
  CHECK(RequestFile("0x R\n").refusal() != "accepted");
  CHECK(RequestFile("12z R\n").refusal() != "accepted");
  CHECK(RequestFile("99999999999999999999999 R\n").refusal() != "accepted");
  CHECK(RequestFile("0 R 5 6 7\n").refusal() != "accepted");
  CHECK(RequestFile("0 R 5 64\n").refusal() == "accepted");
  CHECK(RequestFile("0 R 5 0\n").refusal() == ": line 1: got '0 R 5 0', expected 1 to 65536 bytes");
  CHECK(RequestFile("0 R nan\n").refusal() != "accepted");
  CHECK(RequestFile("0 R 5\n0 R 4\n").refusal() ==
        ": line 2: got '0 R 4', expected a time in ns that does not decrease");
  CHECK_THROWS_AS(read_request_trace("/nowhere/x"), InputError);
}

}  // namespace
}  // namespace sgs

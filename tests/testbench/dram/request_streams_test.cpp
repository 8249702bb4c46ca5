// Request streams to the bit, and request traces read without mercy.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "algorithm/files/input_error.h"
#include "testbench/dram/stream_bench.h"

namespace sgs {
namespace {

// FNV-1a of 64 bits over the eight little-endian bytes of (address | write) of `count` requests.
// The offset basis is 1469598103934665603, FNV's without its last digit: the figures that others
// can compare with were made with it.
std::uint64_t stream_hash(const StreamSpec& spec, std::uint64_t count) {
  RequestGenerator generator(spec);
  std::uint64_t hash = 1469598103934665603u;
  for (std::uint64_t i = 0; i < count; ++i) {
    const MemoryRequest request = generator.next();
    const std::uint64_t word = request.address | (request.write ? 1u : 0u);
    for (int byte = 0; byte < 8; ++byte) {
      hash ^= (word >> (8 * byte)) & 0xff;
      hash *= 0x100000001b3u;
    }
  }
  return hash;
}

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
      read_request_trace(path_, 1.25);
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
  const RequestTrace trace = read_request_trace(file.path(), 1.25);
  CHECK(trace.form.empty());
  const std::vector<MemoryRequest>& requests = trace.requests;
  REQUIRE(requests.size() == 3);
  CHECK(requests[0].address == 64);
  CHECK_FALSE(requests[0].write);
  CHECK(requests[1].write);
  CHECK(requests[1].not_before_ns == 10.5);
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
  CHECK_THROWS_AS(read_request_trace("/nowhere/x", 1.25), InputError);
}

TEST_CASE("request trace: those of DRAMSys and DRAMsim3 are recognised by their first request") {
  const RequestFile stl("# comment\n2:\twrite\t0x40\n3: (16) read 0x80\n3 write 0x0 0xffff\n");
  const RequestTrace dramsys = read_request_trace(stl.path(), 2.5);
  CHECK(dramsys.form == "DRAMSys");
  REQUIRE(dramsys.requests.size() == 3);
  CHECK(dramsys.requests[0].write);
  CHECK(dramsys.requests[0].address == 0x40);
  CHECK(dramsys.requests[0].not_before_ns == 5);
  CHECK(dramsys.requests[0].bytes == 0);
  CHECK_FALSE(dramsys.requests[1].write);
  CHECK(dramsys.requests[1].bytes == 16);
  CHECK(dramsys.requests[2].not_before_ns == 7.5);
  const RequestFile spaced("0x2000D5C0 READ  30\n0x1FF96FC0 WRITE   160\n");
  const RequestTrace dramsim3 = read_request_trace(spaced.path(), 2.5);
  CHECK(dramsim3.form == "DRAMsim3");
  REQUIRE(dramsim3.requests.size() == 2);
  CHECK(dramsim3.requests[0].address == 0x2000d5c0);
  CHECK_FALSE(dramsim3.requests[0].write);
  CHECK(dramsim3.requests[1].write);
  CHECK(dramsim3.requests[1].not_before_ns == 400);
}

TEST_CASE("request trace: a permuted one, a mixture and relative times are refused") {
  for (const char* text : {"10 R 0x40\n",                                    // time first
                           "R 0x40 10\n",                                    // direction first
                           "0x40 10 R\n",                                    // direction last
                           "# nanoseconds R|W address bytes\n10 R 64 32\n",  // by its header
                           "0x40 2: write\n",                                // DRAMSys's
                           "write 0x40 2\n", "2: 0x40 write\n", "2: write 64\n", "READ 0x40 30\n",
                           "30 READ 0x40\n", "0x40 READ 0x30\n",  // DRAMsim3's
                           "0 R\n2: write 0x40\n", "2: write 0x40\n0x40 READ 30\n"}) {
    INFO(text);
    CHECK(RequestFile(text).refusal() != "accepted");
  }
  CHECK(RequestFile("# nanoseconds R|W address\n").refusal() ==
        ": line 1: got '# nanoseconds R|W address', expected '# address R|W nanoseconds bytes'");
  CHECK(RequestFile("2: write 0x40\n3: erase 0x40\n").refusal() ==
        ": line 2: got '3: erase 0x40', expected CYCLE: [(BYTES)] read|write 0xADDRESS [0xDATA] as "
        "in the lines before, of a DRAMSys trace");
  CHECK(RequestFile("READ 0x40 30\n").refusal() ==
        ": line 1: got 'READ 0x40 30', expected ADDRESS R|W [NANOSECONDS [BYTES]], or DRAMSys's "
        "CYCLE: [(BYTES)] read|write 0xADDRESS [0xDATA], or DRAMsim3's 0xADDRESS READ|WRITE CYCLE");
  CHECK_THROWS_AS(read_request_trace("relative.rstl", 1.25), InputError);
}

}  // namespace
}  // namespace sgs

// Request traces as text.
#include "modules/dram/request_trace.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {

namespace {

constexpr std::uint64_t kMostBytes = 65536;

bool parse_address(const std::string& text, std::uint64_t& address) {
  if (text.empty() || text[0] < '0' || text[0] > '9') return false;
  const bool hex = text.compare(0, 2, "0x") == 0;
  char* end = nullptr;
  errno = 0;
  address = std::strtoull(text.c_str() + (hex ? 2 : 0), &end, hex ? 16 : 10);
  return errno == 0 && end != text.c_str() + (hex ? 2 : 0) && *end == '\0';
}

}  // namespace

std::vector<MemoryRequest> read_request_trace(const std::string& path) {
  LineReader lines(path);
  std::vector<MemoryRequest> requests;
  double last_ns = 0;
  for (std::string_view line; lines.next(line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto refuse = [&](const char* expected) {
      throw InputError(fmt::format("{}: line {}: got '{}', expected {}", path, lines.line_number(),
                                   line, expected));
    };
    std::istringstream fields{std::string(line)};
    std::string address, direction, time, bytes, rest;
    fields >> address >> direction >> time >> bytes >> rest;
    MemoryRequest request;
    if (!parse_address(address, request.address) || (direction != "R" && direction != "W") ||
        !rest.empty())
      refuse("ADDRESS R|W [NANOSECONDS [BYTES]]");
    request.write = direction == "W";
    if (!time.empty()) {
      char* end = nullptr;
      request.not_before_ns = std::strtod(time.c_str(), &end);
      if (*end != '\0' || !(request.not_before_ns >= last_ns && request.not_before_ns < 1e12))
        refuse("a time in ns that does not decrease");
      last_ns = request.not_before_ns;
    }
    if (!bytes.empty()) {
      std::uint64_t count = 0;
      if (!parse_address(bytes, count) || count < 1 || count > kMostBytes)
        refuse("1 to 65536 bytes");
      request.bytes = static_cast<std::uint32_t>(count);
    }
    requests.push_back(request);
  }
  return requests;
}

RequestTraceWriter::RequestTraceWriter(OutputFile& to) : to_(to) {
  to_.write("# address R|W nanoseconds bytes\n");
}

void RequestTraceWriter::add(const MemoryRequest& r) {
  to_.write(fmt::format("0x{:x} {} {:.6f} {}\n", r.address, r.write ? 'W' : 'R', r.not_before_ns,
                        r.bytes));
}

}  // namespace sgs

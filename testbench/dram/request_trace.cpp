// Request traces.
#include "testbench/dram/request_trace.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "algorithm/input_error.h"

namespace sgs {

namespace {

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
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read, expected a request trace", path));
  std::vector<MemoryRequest> requests;
  std::string text;
  double last_ns = 0;
  for (std::uint64_t line = 1; std::getline(file, text); ++line) {
    if (text.empty() || text[0] == '#') continue;
    const auto refuse = [&](const char* expected) {
      throw InputError(
          fmt::format("{}: line {}: got '{}', expected {}", path, line, text, expected));
    };
    std::istringstream fields(text);
    std::string address, direction, time, rest;
    fields >> address >> direction >> time >> rest;
    MemoryRequest request;
    if (!parse_address(address, request.address) || (direction != "R" && direction != "W") ||
        !rest.empty())
      refuse("ADDRESS R|W [NANOSECONDS]");
    request.write = direction == "W";
    if (!time.empty()) {
      char* end = nullptr;
      request.not_before_ns = std::strtod(time.c_str(), &end);
      if (*end != '\0' || !(request.not_before_ns >= last_ns && request.not_before_ns < 1e12))
        refuse("a time in ns that does not decrease");
      last_ns = request.not_before_ns;
    }
    requests.push_back(request);
  }
  return requests;
}

}  // namespace sgs

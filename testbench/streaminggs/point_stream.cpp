// Bytes into lines.
#include "testbench/streaminggs/point_stream.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "algorithm/input_error.h"

namespace sgs {

std::vector<SweepPoint> PointStream::receive() {
  std::array<char, 1U << 16U> block;
  const ssize_t got = ::read(descriptor_, block.data(), block.size());
  std::vector<SweepPoint> points;
  if (got < 0 && errno == EINTR) return points;
  if (got < 0) {
    throw std::runtime_error(
        fmt::format("standard input cannot be read ({})", std::strerror(errno)));
  }
  if (got == 0) {
    ended_ = true;
    add(rest_, points);
    return points;
  }
  rest_.append(block.data(), static_cast<std::size_t>(got));
  std::size_t begin = 0;
  for (std::size_t end; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    add(rest_.substr(begin, end - begin), points);
  }
  rest_.erase(0, begin);
  return points;
}

void PointStream::add(const std::string& line, std::vector<SweepPoint>& points) {
  ++lines_;
  const std::string content = content_of(line);
  if (content.empty()) return;
  try {
    points.push_back(parse_point(content, fmt::format("standard input, line {}", lines_)));
  } catch (const InputError& error) {
    points.emplace_back().refused = error.what();
  }
}

}  // namespace sgs

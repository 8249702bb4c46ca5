// Bytes into lines.
#include "testbench/streaminggs/sweep/point_stream.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "algorithm/files/input_error.h"

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
    end_line(points);
    return points;
  }
  std::string_view left(block.data(), static_cast<std::size_t>(got));
  for (std::size_t end; (end = left.find('\n')) != std::string_view::npos;) {
    take(left.substr(0, end), points);
    end_line(points);
    left.remove_prefix(end + 1);
  }
  take(left, points);
  return points;
}

void PointStream::take(std::string_view piece, std::vector<SweepPoint>& points) {
  if (too_long_) return;
  if (line_.size() + piece.size() <= kLongestLineBytes) {
    line_.append(piece);
    return;
  }
  too_long_ = true;
  line_.clear();
  points.emplace_back().refused =
      fmt::format("{}: got more than {} B, expected KEY=VALUE ..., or a JSON object", place(),
                  kLongestLineBytes);
}

void PointStream::end_line(std::vector<SweepPoint>& points) {
  const std::string content = content_of(line_);
  if (!content.empty()) {
    try {
      points.push_back(parse_point(content, place()));
    } catch (const InputError& error) {
      points.emplace_back().refused = error.what();
    }
  }
  line_.clear();
  too_long_ = false;
  ++number_;
}

std::string PointStream::place() const { return fmt::format("standard input, line {}", number_); }

}  // namespace sgs

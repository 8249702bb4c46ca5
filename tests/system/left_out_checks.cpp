#include "tests/system/left_out_checks.h"

#include <catch2/catch.hpp>
#include <utility>

namespace sgs::test {
namespace {

std::uint64_t read_of(const Json& view, const char* region) {
  return region_bytes(view, region, "read");
}

}  // namespace

Value region(const char* name) {
  return [name](const Json& v) { return read_of(v, name); };
}
Value sum(const char* counter) {
  return [counter](const Json& v) { return total(v, counter); };
}
Value of_scene(const char* key) {
  return [key](const Json& v) { return v["scene"][key].get<std::uint64_t>(); };
}
Value bytes() {
  return [](const Json& v) { return v["dram"]["bytes"].get<std::uint64_t>(); };
}
Counted known(std::uint64_t count) {
  return [count](const Json&, const Json&) { return count; };
}

void check(const std::string& label, const Arguments& saving, const Arguments& off,
           const std::vector<Saving>& rows) {
  INFO(label);
  const Simulation with(saving), without(off);
  with.check();
  without.check();
  CHECK(with.frame(0) == without.frame(0));
  const Json &view = with.views()[0], &plain = without.views()[0];
  CHECK(view["image"]["empty"] == false);
  for (const Saving& row : rows) {
    INFO(row.what);
    CHECK(left_out(view, row.what) > 0);
    CHECK(left_out(view, row.what) == row.counted(view, plain));
    CHECK(left_out(plain, row.what) == row.left);
    CHECK(row.work(plain) > row.work(view));
  }
}

std::vector<Ball> diagonal() {
  std::vector<Ball> balls;
  for (const float middle : {8.0F, 24.0F, 40.0F, 56.0F}) {
    balls.push_back({at_pixel(middle, middle, 4)});
  }
  return balls;
}

Arguments plus(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

GaussianCloud layers() {
  std::vector<Ball> balls;
  for (int layer = 0; layer < 150; ++layer) {
    const float depth = 4 + 0.02F * static_cast<float>(layer);
    for (const auto& [column, row] : {std::pair(0, 0), {2, 0}, {0, 2}, {2, 2}, {3, 3}}) {
      for (int at = 0; at < 16; ++at) {
        const float x = static_cast<float>(16 * column + 2 + 4 * (at % 4));
        const float y = static_cast<float>(16 * row + 2 + 4 * (at / 4));
        balls.push_back({at_pixel(x, y, depth), 3 * depth / 64});
      }
    }
  }
  balls.push_back({at_pixel(56, 24, 4)});
  return cloud_of(balls);
}

}  // namespace sgs::test

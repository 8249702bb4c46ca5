// Shapes of pixel groups, against all shapes there are.
#include "algorithm/render/group_shape.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <tuple>
#include <vector>

namespace sgs {
namespace {

constexpr int kMostPx = 1020;

using Frames = std::vector<PixelSize>;

PixelSize of_at_most(int pixels, const Frames& frames, int step_px) {
  return group_for_frame(frames, step_px, kMostPx, [&](const PixelSize& group) {
    return group.width * group.height <= pixels;
  });
}

// Where groups begin and end, px by px.
std::uint64_t borders_counted(const Frames& frames, const PixelSize& group) {
  std::uint64_t sum = 0;
  for (const PixelSize& frame : frames) {
    for (int x = 1; x < frame.width; ++x) sum += x % group.width == 0 ? frame.height : 0;
    for (int y = 1; y < frame.height; ++y) sum += y % group.height == 0 ? frame.width : 0;
  }
  return sum;
}

struct Row {
  Frames frames;
  int pixels;  // of a group, at most
  int step_px;
  PixelSize group;
};

TEST_CASE("group for a frame: the shapes of a table") {
  for (const Row& row : {
           Row{{{640, 360}}, 128 * 128, 4, {128, 120}},
           {{{640, 360}}, 160 * 120, 4, {160, 120}},
           {{{640, 360}}, 64 * 64, 4, {64, 60}},
           {{{640, 360}}, 320 * 180, 4, {320, 180}},
           {{{640, 360}}, 320 * 180 - 1, 4, {216, 180}},
           {{{640, 360}}, 640 * 360, 4, {640, 360}},
           {{{640, 360}}, 1 << 30, 4, {640, 360}},  // no larger than the frame
           {{{641, 361}}, 1 << 30, 4, {644, 364}},  // whole sub-tiles
           {{{641, 361}}, 1 << 30, 8, {648, 368}},  // whole parts
           {{{1, 1}}, 1 << 30, 4, {4, 4}},
           {{{4000, 1}}, 4 * 1000, 4, {1000, 4}},
           {{{1, 4000}}, 4 * 1000, 4, {4, 1000}},
           {{{4000, 4}}, 1 << 30, 4, {1000, 4}},  // no longer than kMostPx
           {{{640, 360}}, 15, 4, {0, 0}},
           {{{640, 360}}, 63, 8, {0, 0}},
       }) {
    const PixelSize& frame = row.frames.front();
    INFO(frame.width << " x " << frame.height << ", " << row.pixels << " px at most");
    const PixelSize group = of_at_most(row.pixels, row.frames, row.step_px);
    CHECK(std::tuple(group.width, group.height) == std::tuple(row.group.width, row.group.height));
  }
}

TEST_CASE("group for a frame: none of the others that fit has shorter borders") {
  const std::vector<Frames> all = {
      {{640, 360}}, {{97, 61}}, {{360, 640}, {640, 360}}, {{1280, 720}, {33, 700}}};
  for (const Frames& frames : all) {
    for (const int pixels : {16, 1000, 4096, 19200, 60000}) {
      for (const int step : {4, 8, 12}) {
        if (step * step > pixels) continue;
        INFO(frames.front().width << " px wide, " << pixels << " px at most, step " << step);
        const PixelSize best = of_at_most(pixels, frames, step);
        REQUIRE(best.width % step == 0);
        REQUIRE(best.height % step == 0);
        CHECK(best.width * best.height <= pixels);
        CHECK(border_px(frames, best) == borders_counted(frames, best));
        std::uint64_t shortest = ~std::uint64_t{0};
        for (int width = step; width <= kMostPx; width += step) {
          for (int height = step; height <= kMostPx; height += step) {
            if (width * height > pixels) break;
            shortest = std::min(shortest, border_px(frames, {width, height}));
          }
        }
        CHECK(border_px(frames, best) == shortest);
      }
    }
  }
}

}  // namespace
}  // namespace sgs

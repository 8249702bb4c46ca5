// Blending of a sub-tile in Verilog beside blend(): every bit of its pixels.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "Vsubtile_blend.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/rects.h"

namespace sgs::test {
namespace {

constexpr std::size_t kInterval = 3, kReadAt = 37, kResultAt = 44;
constexpr std::size_t kSubtiles = 3;  // in turn: a sub-tile comes again as early as its loop allows
constexpr PixelSize kFrame{38, 27};   // whose last column and row of sub-tiles are cut

std::uint32_t bits_of(float x) { return __builtin_bit_cast(std::uint32_t, x); }
float float_of(std::uint32_t bits) { return __builtin_bit_cast(float, bits); }

struct Item {
  Splat splat;
  int x, y;  // sub-tile
};

// A pixel as pixel_memory.v has it, the lowest word first.
std::array<std::uint32_t, 4> pixel_of(const SubtileState& state, int lane, bool is_inside) {
  const std::uint32_t is_finished = is_inside && state.active[lane] == 0 ? 0x80000000U : 0;
  return {bits_of(state.blue[lane]), bits_of(state.green[lane]), bits_of(state.red[lane]),
          bits_of(state.transmittance[lane]) | is_finished};
}

class SubtileBlend {
 public:
  explicit SubtileBlend(std::vector<Item> items) : items_(std::move(items)) {
    for (std::size_t i = 0; i < kSubtiles; ++i) {
      states_[i] = make_subtile(items_[i].x, items_[i].y, kFrame.width, kFrame.height);
      fresh_[i] = states_[i];
    }
  }

  // Item i is given in cycle 3 i + 2, and begins behind it.
  void run() {
    const std::size_t cycles = items_.size() * kInterval + kResultAt + kInterval;
    for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
      module_->phase = static_cast<std::uint8_t>(cycle % kInterval);
      if (const Item* item = at(cycle, kInterval - 1)) give(*item);
      if (at(cycle, kInterval + kReadAt) != nullptr)
        read((cycle - kInterval - kReadAt) / kInterval);
      module_->clock = 0;
      module_->eval();
      if (at(cycle, kInterval + kResultAt) != nullptr) {
        check((cycle - kInterval - kResultAt) / kInterval);
      }
      module_->clock = 1;
      module_->eval();
    }
  }
  std::size_t finished() const { return finished_; }

 private:
  const Item* at(std::size_t cycle, std::size_t since) const {
    if (cycle < since || (cycle - since) % kInterval != 0) return nullptr;
    const std::size_t i = (cycle - since) / kInterval;
    return i < items_.size() ? &items_[i] : nullptr;
  }
  void give(const Item& item) {
    const Splat& s = item.splat;
    const Log2Conic<float> conic = log2_conic(s.conic_a, s.conic_b, s.conic_c);
    const float words[] = {s.x,       s.y,     conic.a, conic.b, conic.c,
                           s.opacity, s.rgb.x, s.rgb.y, s.rgb.z};
    for (int i = 0; i < 9; ++i) module_->splat[i] = bits_of(words[i]);
    module_->left = bits_of(static_cast<float>(item.x * kSubtilePx));
    module_->top = bits_of(static_cast<float>(item.y * kSubtilePx));
  }
  bool is_inside(std::size_t of, int lane) const { return fresh_[of].active[lane] != 0; }
  void read(std::size_t item) {
    const std::size_t of = item % kSubtiles;
    module_->is_inside = 0;
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      if (is_inside(of, lane)) module_->is_inside |= 1U << lane;
      const auto pixel = pixel_of(states_[of], lane, is_inside(of, lane));
      for (int word = 0; word < 4; ++word) module_->states[4 * lane + word] = pixel[word];
    }
  }
  void check(std::size_t i) {
    const Item& item = items_[i];
    SubtileState& state = states_[i % kSubtiles];
    const SubtileState before = state;
    blend(state, item.x, item.y, item.splat);
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      auto got = pixel_of(before, lane, is_inside(i % kSubtiles, lane));
      for (int word = 0; word < 4; ++word) {
        const std::uint32_t writes = word == 3 ? module_->writes_light : module_->writes_colour;
        if ((writes >> lane & 1) != 0) got[word] = module_->results[4 * lane + word];
      }
      const auto expected = pixel_of(state, lane, is_inside(i % kSubtiles, lane));
      if (got != expected) {
        FAIL("item " << i << ", lane " << lane << ": light " << float_of(got[3]) << ", red "
                     << float_of(got[2]) << ", expected " << float_of(expected[3]) << ", "
                     << float_of(expected[2]));
      }
    }
    if ((module_->is_finished != 0) != sgs::finished(state)) FAIL("item " << i << ": finished");
    // Begins anew, so that much is blended.
    if (!sgs::finished(state)) return;
    ++finished_;
    state = fresh_[i % kSubtiles];
  }

  const std::vector<Item> items_;
  std::array<SubtileState, kSubtiles> states_{}, fresh_{};
  std::size_t finished_ = 0;
  std::unique_ptr<Vsubtile_blend> module_ = std::make_unique<Vsubtile_blend>();
};

// From specks to giants, faint to opaque, inside and beside the sub-tile.
std::vector<Item> random_items(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  std::vector<Item> items(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<std::array<int, 2>, kSubtiles> places = {{{1, 2}, {9, 3}, {4, 6}}};
    Item& item = items[i];
    item.x = places[i % kSubtiles][0];
    item.y = places[i % kSubtiles][1];
    Splat& s = item.splat;
    const float size = std::exp2(uniform(-14, 1.7F)), ratio = std::exp2(uniform(-4, 4));
    s.conic_a = size * ratio;
    s.conic_c = size / ratio;
    s.conic_b = uniform(-0.999F, 0.999F) * std::sqrt(s.conic_a * s.conic_c);
    const float reach = random() % 4 == 0 ? 40 : 4;
    s.x = static_cast<float>(item.x * kSubtilePx) + uniform(-reach, reach);
    s.y = static_cast<float>(item.y * kSubtilePx) + uniform(-reach, reach);
    s.opacity = random() % 4 == 0 ? 1 : uniform(0, 1);
    s.rgb = {uniform(0, 1), random() % 4 == 0 ? 0 : uniform(0, 2), uniform(0, 0.01F)};
  }
  return items;
}

void check_random(std::size_t count, std::uint64_t seed) {
  SubtileBlend blend(random_items(count, seed));
  blend.run();
  CHECK(blend.finished() > count / 100);
}

}  // namespace

TEST_CASE("blend in Verilog: random splats") { check_random(1'000, 0); }
TEST_CASE("blend in Verilog: many splats", "[nightly]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) check_random(20'000, seed);
}

}  // namespace sgs::test

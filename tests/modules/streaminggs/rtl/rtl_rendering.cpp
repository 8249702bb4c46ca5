// The model that Verilator makes, without SystemC, whose headers want another clock of it.
#include "tests/modules/streaminggs/rtl/rtl_rendering.h"

#include <memory>
#include <optional>

#include "Vrendering_unit.h"
#include "algorithm/render/group_state.h"

namespace sgs::test {
namespace {

constexpr int kResetCycles = 256;
constexpr int kPixelsAtOnce = 8, kWordsOfPixel = 4;
constexpr std::uint32_t kLightBits = 0x7FFFFFFF;  // in front of them: whether it is finished

std::uint32_t bits_of(float x) { return __builtin_bit_cast(std::uint32_t, x); }

class Unit {
 public:
  Unit(const std::vector<PixelRect>& groups, const std::vector<std::vector<Splat>>& splats,
       std::uint64_t first_token)
      : groups_(groups), splats_(splats), next_token_(first_token), frame_{{}, 0, 0} {
    frame_.groups.resize(groups.size());
    open();
    module_->reset = 1;
    for (int i = 0; i < kResetCycles; ++i) clock();
    module_->reset = 0;
  }
  RtlFrame run() {
    for (; group_ < groups_.size(); ++now_) {
      offer();
      module_->clock = 0;
      module_->eval();
      look();
      module_->clock = 1;
      module_->eval();
      if (is_drained_ && ++group_ < groups_.size()) open();
      is_drained_ = false;
    }
    return frame_;
  }

 private:
  void clock() {
    module_->clock = 0;
    module_->eval();
    module_->clock = 1;
    module_->eval();
  }
  void open() {
    const PixelRect& px = groups_[group_];
    state_.emplace(px, px.x1, px.y1);
    module_->group_x = static_cast<std::uint16_t>(px.x0 / kSubtilePx);
    module_->group_y = static_cast<std::uint16_t>(px.y0 / kSubtilePx);
    module_->group_width = static_cast<std::uint16_t>(px.width());
    module_->group_height = static_cast<std::uint16_t>(px.height());
    frame_.groups[group_].pixels.resize(static_cast<std::size_t>(px.width()) * px.height());
    splat_ = 0;
    has_ended_ = false;
  }
  void offer() {
    const std::vector<Splat>& splats = splats_[group_];
    module_->is_token = now_ >= next_token_ && !has_ended_;
    module_->is_splat = splat_ < splats.size();
    module_->is_end = splat_ == splats.size();
    if (splat_ >= splats.size()) return;
    const Splat& s = splats[splat_];
    const float words[] = {s.x,       s.y,     s.conic_a, s.conic_b, s.conic_c,
                           s.opacity, s.rgb.x, s.rgb.y,   s.rgb.z};
    for (int i = 0; i < 9; ++i) module_->splat[i] = bits_of(words[i]);
    const SubtileRect box = state_->box_of(s).subtiles;
    module_->footprint = box.x0 | box.y0 << 8 | box.x1 << 16 | box.y1 << 24;
  }
  void look() {
    RtlGroup& group = frame_.groups[group_];
    if (module_->takes) {
      frame_.hidden += module_->is_splat && module_->is_hidden ? 1 : 0;
      has_ended_ = module_->is_end != 0;
      ++splat_;
    }
    frame_.blends += static_cast<std::uint64_t>(__builtin_popcount(module_->pushes));
    if (module_->closes) group.closes = now_;
    if (module_->has_pixels) keep_pixels(group);
    if (!module_->drain_ends) return;
    group.drained = now_ + 1;
    is_drained_ = true;
  }
  void keep_pixels(RtlGroup& group) {
    const int width = groups_[group_].width();
    for (int i = 0; i < kPixelsAtOnce && module_->pixel_x + i < width; ++i) {
      const auto* word = &module_->pixels[kWordsOfPixel * i];
      group.pixels[static_cast<std::size_t>(module_->pixel_y) * width + module_->pixel_x + i] = {
          word[2], word[1], word[0], word[3] & kLightBits};
    }
  }

  const std::vector<PixelRect>& groups_;
  const std::vector<std::vector<Splat>>& splats_;
  const std::uint64_t next_token_;
  RtlFrame frame_;
  std::optional<GroupState> state_;  // for footprints
  std::size_t group_ = 0, splat_ = 0;
  std::uint64_t now_ = 0;
  bool has_ended_ = false, is_drained_ = false;
  std::unique_ptr<Vrendering_unit> module_ = std::make_unique<Vrendering_unit>();
};

}  // namespace

RtlFrame render_in_verilog(const std::vector<PixelRect>& groups,
                           const std::vector<std::vector<Splat>>& splats,
                           std::uint64_t first_token) {
  return Unit(groups, splats, first_token).run();
}

}  // namespace sgs::test

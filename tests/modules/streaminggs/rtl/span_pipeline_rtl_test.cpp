// Spans of rows in Verilog beside RowSpans: the sub-tiles of every row.
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "Vspan_pipeline.h"
#include "algorithm/render/group_state.h"
#include "testbench/units/random_scene.h"

namespace sgs::test {
namespace {

std::uint32_t bits_of(float x) { return __builtin_bit_cast(std::uint32_t, x); }

struct Span {
  std::uint32_t first = 0, past = 0;
  bool empty() const { return past <= first; }
};
bool operator==(const Span& a, const Span& b) {
  return (a.empty() && b.empty()) || (a.first == b.first && a.past == b.past);
}

// What a group's sub-tiles are, of each row of the splat; none if its rows get no spans.
std::vector<Span> spans_of(const Splat& splat, const PixelRect& group, const PixelSize& frame) {
  GroupState state(group, frame.width, frame.height);
  const int corner = group.x0 / kSubtilePx;
  std::vector<Span> spans;
  const auto note = [&](const SubtileReach& reach) {
    const auto x = static_cast<std::uint32_t>(reach.x - corner);
    spans.resize(reach.row + 1);
    Span& span = spans.back();
    if (span.empty()) span = {x, x};
    span.past = x + 1;
  };
  if (!state.box_of(splat).spanned) return {};
  const BlendWork work = state.blend_scheduled(splat, note);
  spans.resize(work.rows);
  return spans;
}

// Splats of one group through the pipeline, one behind the other.
class SpanPipeline {
 public:
  explicit SpanPipeline(const PixelRect& group) {
    module_->group_x = static_cast<std::uint16_t>(group.x0 / kSubtilePx);
    module_->group_y = static_cast<std::uint16_t>(group.y0 / kSubtilePx);
    module_->reset = 1;
    step();
    module_->reset = 0;
  }
  void begin(const Splat& splat, const SubtileRect& box) {
    const float words[] = {splat.x,       splat.y,       splat.conic_a,
                           splat.conic_b, splat.conic_c, splat.opacity};
    for (int i = 0; i < 6; ++i) module_->splat[i] = bits_of(words[i]);
    module_->footprint = box.x0 | box.y0 << 8 | box.x1 << 16 | box.y1 << 24;
    module_->begins = 0;
    module_->eval();
    while (!module_->begin_turn) step();
    module_->begins = 1;
    step();
    module_->begins = 0;
  }
  void step() {
    module_->clock = 0;
    module_->eval();
    if (module_->ends) spans_.push_back({module_->first, module_->past});
    module_->clock = 1;
    module_->eval();
  }
  const std::vector<Span>& spans() const { return spans_; }

 private:
  std::unique_ptr<Vspan_pipeline> module_ = std::make_unique<Vspan_pipeline>();
  std::vector<Span> spans_;
};

constexpr PixelSize kFrame{640, 360};

// As real scenes have them: from specks to needles and giants.
Splat any_splat(std::mt19937_64& random, const PixelRect& group, const StreamingJob& job) {
  Splat splat = tb::random_splat(random, group, job, 0, 1.0F);
  std::uniform_real_distribution<float> one(0, 1);
  if (random() % 2 == 0) {
    const float size = std::exp2(one(random) * 14 - 12), ratio = std::exp2(one(random) * 10 - 5);
    splat.conic_a = size * ratio;
    splat.conic_c = size / ratio;
    const float lean = 1 - std::exp2(-one(random) * 14);
    splat.conic_b = (random() % 2 == 0 ? lean : -lean) * std::sqrt(splat.conic_a * splat.conic_c);
  }
  splat.opacity = std::max(splat.opacity, 1.01F / 255);
  splat.footprint = tb::subtiles_of({0, 0, kFrame.width, kFrame.height});
  if (random() % 2 == 0) splat.footprint.x1 = static_cast<std::uint16_t>(group.x0 / 4 + 5);
  return splat;
}

void check_random(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const StreamingJob job =
      tb::frame_job(kFrame.width, kFrame.height, square_of(96), FrameFormat::kRgb8, 0);
  const PixelRect group = job.groups[random() % job.groups.size()];
  const GroupState state(group, kFrame.width, kFrame.height);
  SpanPipeline pipeline(group);
  std::vector<Span> expected;
  while (count > 0) {
    const Splat splat = any_splat(random, group, job);
    const std::vector<Span> spans = spans_of(splat, group, kFrame);
    if (spans.empty()) continue;
    expected.insert(expected.end(), spans.begin(), spans.end());
    pipeline.begin(splat, state.box_of(splat).subtiles);
    for (std::size_t row = 0; row < 2 * spans.size(); ++row) pipeline.step();
    --count;
  }
  for (int i = 0; i < 400; ++i) pipeline.step();
  REQUIRE(pipeline.spans().size() == expected.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(pipeline.spans()[i] == expected[i])) {
      ++differ;
      if (differ < 10) {
        UNSCOPED_INFO("row " << i << ": " << pipeline.spans()[i].first << " to "
                             << pipeline.spans()[i].past << ", expected " << expected[i].first
                             << " to " << expected[i].past);
      }
    }
  }
  CHECK(differ == 0);
}

}  // namespace

TEST_CASE("spans in Verilog: random splats") { check_random(500, 0); }
TEST_CASE("spans in Verilog: many splats", "[nightly]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) check_random(5'000, seed);
}

}  // namespace sgs::test

// order_loss.h with the designs of both orders: each loss is charged with what it costs.
#include "testbench/streaminggs/run/order_loss.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/render/reference_renderer.h"
#include "modules/machines.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs {
namespace {

// A view of the built-in object up to the golden picture, which serves as the frame.
struct GoldenView {
  explicit GoldenView(const std::vector<std::string>& overrides) {
    ConfigDocument document;
    for (const std::string& assignment : overrides) document.add_override(assignment);
    config = read_run_config(document, machine_kinds());
    resolve(config);
    Scene opened = open_scene("builtin:object?n=3000");
    const std::vector<Camera> cameras = opened.cameras;
    scene = prepare(std::move(opened), config, cameras);
    job = config.design->job(scene.stored, scaled_to(cameras[0], 128, 72));
    reference = render_reference(job.view, scene.given()).image;
    decoded_reference = render_reference(job.view, scene.stored.decoded).image;
    DataSheet unread;
    golden = config.design->golden(scene.stored, job, unread);
  }
  OrderLoss loss() const {
    return order_loss(scene.stored.original_known() ? &reference : nullptr, decoded_reference,
                      golden, golden.image);
  }

  RunConfig config;
  PreparedScene scene;
  FrameJob job;
  Image reference, decoded_reference;
  GoldenFrame golden;
};

double squares(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      sum += std::pow(static_cast<double>(std::clamp(a.pixels[i][c], 0.0F, 1.0F)) -
                          std::clamp(b.pixels[i][c], 0.0F, 1.0F),
                      2);
    }
  }
  return sum;
}

TEST_CASE("order loss: paper order, parts add up to the whole") {
  for (const char* encoding : {"storage.encoding=raw", "storage.encoding=half"}) {
    const GoldenView view({"machine=paper", "group_width_px=32", "group_height_px=32",
                           "storage.voxel_size=0.4", encoding, "rendering.precision=fp32"});
    REQUIRE(view.golden.missed > 0);
    REQUIRE(view.golden.misordered > 0);
    const OrderLoss loss = view.loss();
    CAPTURE(encoding);
    REQUIRE(loss.encoding);
    CHECK(loss.encoding->share + loss.missed.share + loss.misordered.share == Approx(1));
    CHECK(loss.pixel_format.share == 0);
    CHECK((loss.encoding->alone > 0) == view.scene.stored.original.has_value());
    const double whole = squares(view.reference, view.golden.image);
    CHECK(loss.missed.alone == Approx(squares(view.decoded_reference, loss.in_order) / whole));
    CHECK(loss.misordered.alone == Approx(squares(loss.in_order, view.golden.image) / whole));
    CHECK(loss.missed.alone > 0.001);
    CHECK(loss.misordered.alone > 0.001);
  }
}

TEST_CASE(
    "order loss: without the original there is no part of the encoding, and the rest is all") {
  GoldenView view({"machine=paper", "group_width_px=32", "group_height_px=32",
                   "storage.voxel_size=0.4", "storage.encoding=half", "rendering.precision=fp32"});
  view.scene.stored.original.reset();
  view.reference = view.decoded_reference;
  const OrderLoss loss = view.loss();
  CHECK_FALSE(loss.encoding);
  CHECK(loss.missed.share + loss.misordered.share == Approx(1));
  const double whole = squares(view.decoded_reference, view.golden.image);
  CHECK(loss.missed.alone == Approx(squares(view.decoded_reference, loss.in_order) / whole));
}

TEST_CASE("order loss: exact order that blends early misses nothing, all is misordering") {
  const GoldenView view({"machine=exact", "merge.entries=16", "merge.on_overflow=blend_early"});
  REQUIRE(view.golden.missed == 0);
  REQUIRE(view.golden.misordered > 0);
  const OrderLoss loss = view.loss();
  CHECK(loss.in_order.pixels == view.decoded_reference.pixels);
  CHECK(loss.missed.share == 0);
  CHECK(loss.misordered.share == Approx(1));
}

TEST_CASE("order loss: what half precision and boxes cost is not the order's") {
  struct Row {
    std::vector<std::string> settings;
    bool loses_order;
  };
  const std::vector<Row> rows = {
      {{"machine=exact", "rendering.precision=fp16"}, false},
      {{"machine=exact", "merge.entries=16", "merge.on_overflow=blend_early",
        "rendering.precision=fp16"},
       true},
      {{"machine=paper", "group_width_px=32", "group_height_px=32", "storage.voxel_size=0.4"},
       true},
      {{"machine=gscore"}, true},
      {{"machine=gscore", "tiles.keys=fp32"}, false},
  };
  for (const Row& row : rows) {
    CAPTURE(row.settings);
    const GoldenView view(row.settings);
    REQUIRE(is_lossy(view.golden));
    CHECK(loses_order(view.golden) == row.loses_order);
    const OrderLoss loss = view.loss();
    REQUIRE(loss.arithmetic);
    CHECK(loss.arithmetic->alone > 0);
    CHECK(loss.missed.share + loss.misordered.share + loss.arithmetic->share == Approx(1));
    CHECK((loss.misordered.alone > 0) == row.loses_order);
    // The same order in single precision and without boxes: what is left of the chain.
    std::vector<std::string> exactly = row.settings;
    for (const char* setting :
         {"rendering.precision=fp32", "tiles.reach=visible", "tiles.features=fp32"}) {
      const bool of_gscore = row.settings[0] == "machine=gscore";
      if (of_gscore || setting[0] == 'r') exactly.emplace_back(setting);
    }
    const GoldenView other(exactly);
    CHECK_FALSE(other.golden.computed_exactly);
    CHECK(loss.exactly.pixels == other.golden.image.pixels);
  }
  CHECK_FALSE(GoldenView({"machine=exact", "merge.entries=16", "merge.on_overflow=blend_early"})
                  .loss()
                  .arithmetic);
}

TEST_CASE("order loss: an order that misses splats must say what they show") {
  GoldenView view({"machine=exact"});
  CHECK_FALSE(is_lossy(view.golden));
  view.golden.missed = 1;
  CHECK_THROWS_AS(view.loss(), std::logic_error);
  const Image black(view.golden.image.width, view.golden.image.height);
  view.golden.in_order = [&] { return black; };
  CHECK(view.loss().in_order.pixels == black.pixels);
}

}  // namespace
}  // namespace sgs

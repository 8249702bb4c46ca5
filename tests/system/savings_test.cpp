// Each saving, switched off: the same pixels, and more work.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

struct Pair {
  Pair(Arguments scene, const std::string& off)
      : with(scene), without([&] {
          scene.insert(scene.end(), {"--set", off});
          return scene;
        }()) {
    with.check();
    without.check();
    for (std::size_t v = 0; v < with.views().size(); ++v) CHECK(with.frame(v) == without.frame(v));
  }
  // A sum over the views.
  template <class Value>
  static std::uint64_t sum(const Simulation& of, Value&& value) {
    std::uint64_t out = 0;
    for (const Json& view : of.views()) out += value(view);
    return out;
  }
  template <class Value>
  void check_more(Value&& value) const {
    CHECK(sum(without, value) > sum(with, value));
  }
  Simulation with, without;
};

const Arguments kSavingsScene =
    with_settings({"builtin:outdoor?n=4000", "--view", "1,2", "--size", "160x90"},
                  {"group_width_px=16", "group_height_px=16"});

Arguments in_order(const char* order) {
  Arguments all = kSavingsScene;
  all.insert(all.end(), {"--config", order});
  return all;
}

TEST_CASE("savings: the coarse filter spares second halves") {
  for (const char* order : {"paper", "exact"}) {
    const Pair pair(in_order(order), "hfu.coarse_filter=false");
    pair.check_more([](const Json& v) { return total(v, "second_halves"); });
    // Exact order has the depths of its keys of the CFUs; in paper order nobody wants any.
    const Json &with = pair.with.views()[0], &without = pair.without.views()[0];
    const double saved =
        with["area_mm2"]["total"].get<double>() - without["area_mm2"]["total"].get<double>();
    if (order == std::string("exact")) {
      CHECK(saved == 0);
      CHECK(without["datapath"]["coarse"]["items"].get<std::uint64_t>() >=
            with["datapath"]["coarse"]["items"].get<std::uint64_t>());
    } else {
      CHECK(saved > 0);
      CHECK(!without["datapath"].contains("coarse"));
    }
  }
}

TEST_CASE("savings: sub-tiles that the ellipse cannot reach are skipped") {
  for (const char* order : {"paper", "exact"}) {
    // In parts of 8 px every splat is on so few sub-tiles that no test pays.
    Arguments wide = in_order(order);
    wide = with_settings(wide, {"group_width_px=64", "group_height_px=64"});
    const Pair pair(wide, "rendering.ellipse_test=false");
    pair.check_more([](const Json& v) { return total(v, "subtile_blends"); });
  }
}

}  // namespace
}  // namespace sgs::test

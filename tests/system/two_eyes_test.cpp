// Frames of two eyes through the command: each picture is that of its own reference, and what both
// need is fetched once.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// Groups so small that eyes end them at different times. What does not fit is sized.
Arguments frame_of(const std::string& machine, const std::string& scene) {
  Arguments arguments = {scene, "--view", "0,2", "--size", "97x61", "--config", machine};
  if (machine.rfind("exact", 0) == 0) {
    return with_settings(arguments, {"group_width_px=24", "group_height_px=16"});
  }
  return arguments;
}

std::string right_frame(const Simulation& simulation, int view) {
  return bytes_of(simulation.folder() + "view_" + std::to_string(view) + "/right_frame.exr");
}

void check_both_equal(const Simulation& simulation) {
  simulation.check();
  for (const Json& view : simulation.views()) {
    CHECK(view["image"]["equals_streaming_renderer"] == true);
    CHECK(view["image"]["psnr_db"].is_null());
    CHECK(view["image"]["right_eye"]["psnr_db"].is_null());
    CHECK(view["image"]["right_eye"]["max_abs_error"] == 0);
  }
}

TEST_CASE("two eyes: each picture is its reference's, with stalls and without") {
  for (const char* machine : {"exact", "gscore_lossless", "gscore_lossless_boxes"}) {
    for (const char* scene : {"builtin:object?n=3000", "builtin:outdoor?n=3000"}) {
      INFO(machine << " " << scene);
      const Arguments one_eye = frame_of(machine, scene);
      const Simulation left(one_eye);
      for (const char* apart : {"0.064", "2"}) {
        const Arguments common = joined(one_eye, {"--stereo", std::string("ipd=") + apart});
        const Simulation pair(common), stalled(joined(common, {"--stalls", "0.2"}));
        check_both_equal(pair);
        check_both_equal(stalled);
        for (std::size_t v = 0; v < left.views().size(); ++v) {
          CHECK(pair.frame(v) == left.frame(v));
          const int number = pair.views()[v]["view"];
          CHECK(right_frame(pair, number) == right_frame(stalled, number));
          CHECK(right_frame(pair, number) != pair.frame(v));
        }
      }
    }
  }
}

TEST_CASE("two eyes: the order of processes changes no number") {
  for (const char* machine : {"exact", "gscore_lossless"}) {
    INFO(machine);
    const Arguments common = joined(frame_of(machine, "builtin:object?n=2000"),
                                    {"--stereo", "ipd=0.1", "--stalls", "0.2"});
    const Simulation first(common);
    for (const char* order : {"1", "2"}) {
      const Simulation other(joined(common, {"--process-order", order}));
      for (std::size_t v = 0; v < first.views().size(); ++v) {
        CHECK(without_host(other.views()[v]) == without_host(first.views()[v]));
      }
    }
  }
}

TEST_CASE("two eyes: what is too large for the chip, tables in passes, encodings that lose") {
  const auto check = [](const std::string& machine, const Arguments& keys) {
    INFO(machine << " " << keys.front());
    const Simulation pair(joined(with_settings(frame_of(machine, "builtin:object?n=3000"), keys),
                                 {"--stereo", "ipd=0.3"}));
    for (const Json& view : pair.views()) {
      CHECK(view["image"]["equals_streaming_renderer"] == true);
    }
  };
  check("exact", {"merge.entries=16", "vsu.queue_entries=9", "vsu.node_queue_entries=9"});
  check("exact", {"hfu.coarse_filter=false"});
  check("exact", {"hfus=1", "hfu.second_half_slots=1", "rendering.input_fifo_entries=1"});
  check("exact_fp16", {"rendering.pixel_buffers=2"});
  check("exact_vq_packed", {"storage.vq.iterations=1"});
  check("gscore", {"lists.tiles=10"});
  check("gscore_boxes", {"lists.sets=2"});
  check("gscore_lossless", {"lists.pool_bytes=1000000"});
}

TEST_CASE("two eyes: one that sees nothing is told") {
  const auto told = [](const char* apart) {
    const ScratchFolder scratch;
    const Outcome done =
        run_streaminggs({"simulate", "builtin:object?n=500", "--size", "32x18", "--stereo", apart,
                         "--fit-memories", "--out", scratch.path("out")});
    INFO(done.err);
    REQUIRE(done.status == 0);
    CHECK(done.out.find("world units beside the left one") != std::string::npos);
    const Json view = Json::parse(bytes_of(scratch.path("out/report.json")))["views"][0];
    CHECK(view["image"]["empty"] == false);
    const bool said = done.out.find("the right eye sees no Gaussian") != std::string::npos;
    CHECK(view["image"]["right_eye"]["empty"] == said);
    return said;
  };
  CHECK(told("ipd=100000"));
  CHECK_FALSE(told("ipd=0.064"));
}

TEST_CASE("two eyes: gscore's Gaussians are queued and tested an eye at a time") {
  const auto queue_of = [](const Simulation& of) {
    for (const Json& use : of.views()[0]["sram"]["uses"]) {
      if (use["name"] == "converted Gaussians") return use;
    }
    return Json();
  };
  const Arguments one_eye = frame_of("gscore_lossless", "builtin:object?n=1000");
  const Simulation left(one_eye), pair(joined(one_eye, {"--stereo", "ipd=0.064"}));
  const Json one = queue_of(left), two = queue_of(pair);
  CHECK(two["width_bits"] == one["width_bits"]);
  CHECK(two["bytes"].get<double>() > 1.5 * one["bytes"].get<double>());
  CHECK(two["writes"] == counter(pair.views()[0], "lister", "gaussians") +
                             counter(pair.views()[0], "lister", "ends_alone"));
}

TEST_CASE("two eyes: what both need is fetched once") {
  const auto bytes = [](const Simulation& of, const char* region) {
    return static_cast<double>(region_bytes(of.views()[0], region, "read"));
  };
  for (const char* machine : {"exact", "gscore_lossless"}) {
    INFO(machine);
    const Arguments one_eye = frame_of(machine, "builtin:object?n=4000");
    const Simulation left(one_eye), pair(joined(one_eye, {"--stereo", "ipd=0.064"}));
    for (const char* region : {"first_halves", "second_halves"}) {
      INFO(region);
      CHECK(bytes(pair, region) >= bytes(left, region));
      CHECK(bytes(pair, region) < 1.2 * bytes(left, region));
    }
    CHECK(region_bytes(pair.views()[0], "right_frame_buffer", "write") ==
          region_bytes(pair.views()[0], "frame_buffer", "write"));
  }
}

}  // namespace
}  // namespace sgs::test

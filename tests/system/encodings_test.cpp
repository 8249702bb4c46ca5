// Second halves in every encoding through the whole accelerator: the picture of what they decode
// to, every byte of them and of their codebooks counted a second time.
#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <tuple>

#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// Codebooks too small for the scene, so that quantising loses something.
Arguments encoded(const std::string& order, const std::string& encoding,
                  const std::string& scene = "builtin:object?n=2000") {
  Arguments arguments = {scene, "--size", "96x54", "--config", order};
  Arguments settings = {"group_width_px=32", "group_height_px=32", "storage.encoding=" + encoding,
                        "sram.codebook_bytes=256000"};
  if (encoding.rfind("vq", 0) == 0) {
    arguments.insert(arguments.end(), {"--weigh-by", "0"});
    settings.insert(settings.end(), {"storage.vq.scale_entries=64",
                                     "storage.vq.rotation_entries=100", "storage.vq.dc_entries=200",
                                     "storage.vq.sh_entries=32", "storage.vq.iterations=3"});
  }
  return with_settings(arguments, settings);
}

double encoding_psnr(const Simulation& simulation) {
  const Json& psnr = simulation.views()[0]["image"]["encoding_psnr_db"];
  return psnr.is_null() ? std::numeric_limits<double>::infinity() : psnr.get<double>();
}

std::uint64_t cycles_of(const Simulation& simulation) {
  return frame_cycles(simulation.views()[0]);
}

TEST_CASE("encodings: the same frame with and without stalls, in both orders") {
  for (const char* order : {"exact", "paper"}) {
    for (const char* encoding : {"half", "vq", "vq_packed"}) {
      INFO(order << " " << encoding);
      const Arguments common = encoded(order, encoding);
      const Simulation plain(common);
      plain.check();
      const Simulation stalled(joined(common, {"--stalls", "0.2", "--seed", "5"}));
      stalled.check();
      CHECK(stalled.frame(0) == plain.frame(0));
      CHECK(cycles_of(stalled) > cycles_of(plain));
    }
  }
}

TEST_CASE("encodings: a record's bytes, and what each encoding costs in the picture") {
  for (const char* order : {"exact", "paper"}) {
    INFO(order);
    const Simulation raw(encoded(order, "raw")), half(encoded(order, "half")),
        words(encoded(order, "vq")), bits(encoded(order, "vq_packed"));
    // By voxels, and by chunks with the largest scale and in whole bursts or powers of two.
    const std::tuple<const Simulation*, int, int> bytes[] = {
        {&raw, 220, 224},
        {&half, 110, 128},
        {&words, 17, 32},
        {&bits, 8, 16}};  // 8 + 6 + 7 + 8 + 5 bit: 34
    for (const auto& [simulation, voxels, chunks] : bytes) {
      const int expected = order == std::string("exact") ? chunks : voxels;
      CHECK(simulation->views()[0]["scene"]["second_half_bytes"] == expected);
    }
    CHECK(encoding_psnr(raw) == std::numeric_limits<double>::infinity());
    CHECK(encoding_psnr(half) > 50);
    CHECK(encoding_psnr(half) < 200);
    CHECK(encoding_psnr(words) > 20);
    CHECK(encoding_psnr(words) < encoding_psnr(half));
    // Both quantised forms hold the same indices.
    CHECK(bits.frame(0) == words.frame(0));
    CHECK(words.frame(0) != half.frame(0));
    CHECK(half.frame(0) != raw.frame(0));
    CHECK(region_bytes(bits.views()[0], "second_halves", "read") <
          region_bytes(words.views()[0], "second_halves", "read"));
  }
}

TEST_CASE("encodings: without feedback every record fetched is decoded and tested") {
  for (const char* order : {"exact", "paper"}) {
    const Simulation simulation(
        joined(encoded(order, "vq_packed"), {"--set", "rendering.saturation_feedback=false"}));
    simulation.check();
    const Json& view = simulation.views()[0];
    CHECK(total(view, "records_decoded") == total(view, "fine_tests"));
    CHECK(total(view, "records_decoded") > 1000);
  }
}

TEST_CASE("encodings: codebooks that an earlier frame left cost no traffic and no time") {
  for (const char* order : {"exact", "paper"}) {
    Arguments common = encoded(order, "vq");
    // Following all rays of the first group takes as long as loading.
    if (order == std::string("paper")) common = with_settings(common, {"vsu.ray_step_px=16"});
    // So many that others wait for what is loaded.
    common = with_settings(common, {"storage.vq.sh_entries=512"});
    const Simulation first(common), next(with_settings(common, {"codebook.preloaded=true"}));
    first.check();
    next.check();
    CHECK(next.frame(0) == first.frame(0));
    CHECK(cycles_of(next) < cycles_of(first));
    // 64 x 12 + 100 x 16 + 200 x 12 + 512 x 180 B
    CHECK(region_bytes(first.views()[0], "codebooks", "read") == 96928);
    CHECK(first.views()[0]["sram"]["codebook_bytes"] == 96928);
    CHECK(total(next.views()[0], "loaded_at_cycle") == 0);
    CHECK(total(first.views()[0], "loaded_at_cycle") > 96928 / 26);  // 25.6 B a cycle at most
  }
}

TEST_CASE("encodings: cameras that weigh the Gaussians change codebooks, and are checked") {
  const Arguments common = encoded("exact", "vq", "builtin:outdoor?n=3000");
  const Simulation by_one(common), by_three(joined(common, {"--weigh-by", "1,2"}));
  by_three.check();
  CHECK(by_one.frame(0) != by_three.frame(0));
  const Outcome refused = run_streaminggs(
      joined(joined({"simulate"}, common), {"--weigh-by", "99", "--out", "/tmp/never"}));
  CHECK(refused.status == 2);
  CHECK(refused.err.find("--weigh-by: got 99") != std::string::npos);
}

}  // namespace
}  // namespace sgs::test

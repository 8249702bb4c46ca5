// Second halves in every encoding through the whole accelerator: the picture of what they decode
// to, every byte of them and of their codebooks counted a second time.
#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "testbench/builtin/builtin_scene.h"
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

TEST_CASE("encodings: nothing is lost where codebooks hold every value") {
  Arguments arguments = with_settings(
      {"builtin:object?n=1500", "--size", "64x36"},
      {"storage.encoding=vq", "sram.codebook_bytes=1000000", "storage.vq.sh_entries=4096"});
  const Simulation vq(arguments);
  vq.check();
  // All but opacity, in 255ths, and scales, through a logarithm.
  CHECK(encoding_psnr(vq) > 45);
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

TEST_CASE("encodings: fewer and narrower banks cost cycles, no pixel") {
  for (const char* order : {"exact", "paper"}) {
    const Arguments common = encoded(order, "vq_packed");
    const Simulation wide(with_settings(common, {"codebook.banks=64", "codebook.line_bytes=64"}));
    const Simulation narrow(with_settings(common, {"codebook.banks=1", "codebook.line_bytes=4"}));
    wide.check();
    narrow.check();
    CHECK(narrow.frame(0) == wide.frame(0));
    CHECK(cycles_of(narrow) > cycles_of(wide));
    const Json &few = narrow.views()[0], &many = wide.views()[0];
    // 55 words a record.
    CHECK(total(few, "lines_read") == 55 * total(few, "records_decoded"));
    CHECK(total(many, "lines_read") < 10 * total(many, "records_decoded"));
    CHECK(total(few, "bank_conflict_cycles") > 100 * total(many, "bank_conflict_cycles"));
  }
}

TEST_CASE("encodings: all views, groups of other sizes, other numbers of units") {
  for (const char* order : {"exact", "paper"}) {
    Arguments six = settings({"hfus=6", "sram.input_bytes=32768", "hfu.second_half_slots=1",
                              "codebook.latency_cycles=50"});
    // Six parts of a square group there are not.
    if (order == std::string("paper")) {
      six = with_settings(six, {"fetch=split", "hfu.slice_gaussians=128"});
    }
    for (const Arguments& variant :
         {Arguments{"--view", "all"}, settings({"hfus=1", "sorting_units=1"}), six,
          settings({"group_width_px=16", "group_height_px=16", "hfu.coarse_filter=false"}),
          settings({"storage.store_invisible=true", "clock_mhz=733"})}) {
      INFO(order << " " << variant[1]);
      Simulation(joined(encoded(order, "vq_packed", "builtin:outdoor?n=2000"), variant)).check();
    }
  }
}

TEST_CASE("encodings: SH of degree 0 has no codebook, a handful of Gaussians hardly any") {
  const ScratchFolder scratch;
  BuiltinScene scene = make_builtin_scene("builtin:object?n=2000");
  std::vector<glm::vec3> constant_terms;
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    constant_terms.push_back(scene.cloud.sh_coeffs[16 * i]);
  }
  scene.cloud.sh_degree = 0;
  scene.cloud.sh_coeffs = constant_terms;
  write_cameras(scratch.path("cameras.json"), scene.cameras);
  for (const std::size_t left : {2000U, 1U, 0U}) {
    scene.cloud.resize(left, 0);
    write_ply(scratch.path("scene.ply"), scene.cloud);
    for (const char* order : {"exact", "paper"}) {
      for (const char* encoding : {"half", "vq", "vq_packed"}) {
        INFO(left << " " << order << " " << encoding);
        const Simulation simulation(joined(encoded(order, encoding, scratch.path("scene.ply")),
                                           {"--cameras", scratch.path("cameras.json")}));
        simulation.check();
        const Json& of = simulation.views()[0]["scene"]["codebooks"];
        CHECK_FALSE(of.contains("sh"));
        if (encoding == std::string("half")) continue;
        CHECK(of.contains("rotation") == (left > 0));
        if (left > 0) CHECK(of["rotation"]["entries"] == std::min<std::size_t>(left, 100));
        const bool words = encoding == std::string("vq");
        const int many = words ? 13 : 4;  // three indices; 8 + 6 + 7 + 8 bit
        const int encoded_bytes = left > 1 ? many : 1;
        // By chunks with the largest scale, in a power of two.
        int by_chunks = 1;
        while (by_chunks < encoded_bytes + 4) by_chunks *= 2;
        CHECK(simulation.views()[0]["scene"]["second_half_bytes"] ==
              (order == std::string("exact") ? by_chunks : encoded_bytes));
      }
    }
  }
}

TEST_CASE("encodings: shapes of ratio 1e-10, scales of 10^7, opacities of 0 and 1, SH of 1e17") {
  const ScratchFolder scratch;
  BuiltinScene scene = make_builtin_scene("builtin:object?n=1000");
  GaussianCloud& cloud = scene.cloud;
  for (std::size_t i = 0; i < cloud.size(); i += 50) {
    cloud.log_scales[i] = {-3, -26, -26};
    cloud.log_scales[i + 1] = {16, -3, 16};
    cloud.log_scales[i + 2] = {-200, -200, -200};
    cloud.opacity_logits[i + 3] = 100;
    cloud.opacity_logits[i + 4] = -200;
    cloud.sh_coeffs[16 * (i + 5)] = glm::vec3(1e17F);
    cloud.sh_coeffs[16 * (i + 6) + 3] = glm::vec3(-1e17F);
  }
  write_ply(scratch.path("scene.ply"), cloud);
  write_cameras(scratch.path("cameras.json"), scene.cameras);
  for (const char* order : {"exact", "paper"}) {
    for (const char* encoding : {"raw", "half", "vq_packed"}) {
      INFO(order << " " << encoding);
      const Simulation simulation(joined(encoded(order, encoding, scratch.path("scene.ply")),
                                         {"--cameras", scratch.path("cameras.json")}));
      simulation.check();
      CHECK(simulation.views()[0]["image"]["blends"].get<int>() > 1000);
    }
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

TEST_CASE("encodings: codebooks that do not fit their buffer are refused with the sum") {
  const ScratchFolder scratch;
  const Outcome refused =
      run_streaminggs(joined(joined({"simulate"}, encoded("exact", "vq")),
                             {"--set", "sram.codebook_bytes=10527", "--out", scratch.path("out")}));
  CHECK(refused.status == 2);
  CHECK(refused.err.find("sram.codebook_bytes: 10527 bytes are there, expected at least 10528: "
                         "scale 768 (64 entries x 12 B) + rotation 1600 (100 entries x 16 B) + "
                         "dc 2400 (200 entries x 12 B) + sh 5760 (32 entries x 180 B)") !=
        std::string::npos);
  CHECK(scratch.file_count() == 0);
  for (const char* setting :
       {"storage.encoding=zip", "storage.vq.sh_entries=0", "storage.vq.dc_entries=65537",
        "codebook.banks=65", "codebook.line_bytes=3", "codebook.latency_cycles=0"}) {
    INFO(setting);
    const Outcome outcome =
        run_streaminggs(joined(joined({"simulate"}, encoded("exact", "vq")),
                               {"--set", setting, "--out", scratch.path("out")}));
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(std::string(setting).substr(0, std::string(setting).find('='))) !=
          std::string::npos);
  }
}

}  // namespace
}  // namespace sgs::test

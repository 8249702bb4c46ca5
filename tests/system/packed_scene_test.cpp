// pack, and simulate, render and info on what it wrote.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/voxel/voxel_grid.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;
using Catch::Matchers::Contains;

// A scene as .ply with its cameras, and the files that pack makes of it.
class PackedScenes {
 public:
  PackedScenes() {
    BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=4000");
    for (std::size_t i = 0; i < scene.cloud.size(); i += 9) scene.cloud.opacity_logits[i] = -9;
    visible_ = stored_gaussians(activate(scene.cloud), Stored::kVisible).size();
    write_ply(ply(), scene.cloud);
    write_cameras(cameras(), scene.cameras);
  }

  std::string ply() const { return folder_.path("outdoor.ply"); }
  std::string cameras() const { return folder_.path("cameras.json"); }
  std::string packed() const { return folder_.path("scene.sgs"); }
  std::string path(const std::string& name) const { return folder_.path(name); }

  Outcome pack(const Arguments& options) const {
    return run_streaminggs(
        joined({"pack", ply(), "--cameras", cameras(), "--out", packed()}, options));
  }
  Arguments view(const std::string& scene) const {
    return {scene, "--cameras", cameras(), "--view", "2", "--size", "160x90"};
  }

  std::size_t visible() const { return visible_; }

 private:
  ScratchFolder folder_;
  std::size_t visible_ = 0;
};

const Arguments kQuantised = settings({"sram.codebook_bytes=65536", "storage.vq.scale_entries=50",
                                       "storage.vq.rotation_entries=70", "storage.vq.dc_entries=60",
                                       "storage.vq.sh_entries=30", "storage.vq.iterations=3"});

struct Case {
  const char* order;
  const char* encoding;
  Arguments options;  // of the accelerator: for pack and for simulate
};

// Of a packed scene the original is at hand where nothing was lost.
void check_encoding_known(const Json& image, bool known) {
  CHECK(image["reference"] == (known ? "scene" : "decoded_scene"));
  CHECK(image.contains("encoding_psnr_db") == known);
  if (!image.contains("error_parts")) return;
  CHECK(image["error_parts"].contains("encoding") == known);
  double sum = 0;
  for (const Json& part : image["error_parts"]) sum += part["share"].get<double>();
  CHECK(sum == Approx(1));
}

TEST_CASE("pack: the file gives the very run that the scene gives") {
  const PackedScenes scenes;
  const Arguments memory = {"--set", "sram.codebook_bytes=65536"};
  for (const Case& c : {Case{"exact", "raw", {}}, Case{"paper", "raw", {}},
                        Case{"exact", "vq", memory}, Case{"paper", "vq_packed", memory},
                        Case{"exact", "half", {"--set", "storage.chunk_gaussians=20"}},
                        Case{"paper", "half", {"--set", "hfu.cost=counted"}}}) {
    INFO(c.order << " " << c.encoding);
    const std::string encoding = std::string("storage.encoding=") + c.encoding;
    Arguments making = {"--config", c.order, "--set", encoding};
    if (encoding.find("vq") != std::string::npos) making = joined(making, kQuantised);
    making = joined(making, c.options);
    const Outcome packed = scenes.pack(making);
    INFO(packed.err);
    REQUIRE(packed.status == 0);

    const Simulation direct(joined(scenes.view(scenes.ply()), making));
    const Simulation from_file(
        joined(scenes.view(scenes.packed()), joined({"--config", c.order}, c.options)));
    CHECK(from_file.frame(0) == direct.frame(0));
    const Json &a = from_file.views()[0], &b = direct.views()[0];
    CHECK(a["image"]["equals_streaming_renderer"] == true);
    for (const char* same : {"frame", "units", "dram", "sram", "energy", "limit", "left_out"}) {
      INFO(same);
      CHECK(a[same] == b[same]);
    }
    CHECK(a["provenance"]["memory_image_xxh64"] == b["provenance"]["memory_image_xxh64"]);
    CHECK(a["scene"] == b["scene"]);
    Json shown = a["config"], expected = b["config"];
    if (std::string(c.order) == "paper") {  // which the scene alone leaves to the model
      CHECK(shown["storage"]["voxel_size"] == a["scene"]["voxel_size"]);
      shown["storage"].erase("voxel_size");
      expected["storage"].erase("voxel_size");
    }
    CHECK(shown == expected);
    CHECK(a["image"]["psnr_db"] == a["image"]["decoded_psnr_db"]);
    check_encoding_known(b["image"], true);
    check_encoding_known(a["image"], encoding == "storage.encoding=raw");
    if (std::string(c.order) == "exact") {
      CHECK(a["image"]["decoded_psnr_db"] == b["image"]["decoded_psnr_db"]);
    }
  }
}

TEST_CASE("pack: render draws the decoded scene in every order") {
  const PackedScenes scenes;
  const auto render = [&](const std::string& scene, const char* ordering, const char* out,
                          const Arguments& more = {}) {
    const Arguments options = {"--ordering", ordering, "--out", scenes.path(out)};
    const Outcome outcome =
        run_streaminggs(joined(joined(joined({"render"}, scenes.view(scene)), options), more));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return bytes_of(scenes.path(out));
  };
  const std::string reference = render(scenes.ply(), "reference", "ply.pfm");
  REQUIRE(scenes.pack({}).status == 0);
  CHECK(render(scenes.packed(), "reference", "a.pfm") == reference);
  CHECK(render(scenes.packed(), "exact", "b.pfm") == reference);

  const std::string paper =
      render(scenes.ply(), "paper", "ply_paper.pfm", {"--config", "paper_no_vq"});
  CHECK(paper != reference);
  REQUIRE(scenes.pack({"--config", "paper", "--set", "storage.encoding=raw"}).status == 0);
  CHECK(render(scenes.packed(), "paper", "c.pfm") == paper);
  CHECK(render(scenes.packed(), "reference", "d.pfm") == reference);
}

// Many Gaussians at one place, more than a chunk has: depths tie, and chunks are in another order
// than the file.
void tie_depths(const std::string& ply) {
  constexpr std::size_t kTied = 64;
  GaussianCloud cloud = read_ply(ply).cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.means[i] = cloud.means[i / kTied * kTied];
  write_ply(ply, cloud);
}

// Some values of each Gaussian. all: also of those that no view can show.
std::vector<std::array<float, 5>> sorted_values(const GaussianCloud& cloud, bool all) {
  const std::vector<std::uint32_t> kept =
      stored_gaussians(activate(cloud), all ? Stored::kAll : Stored::kVisible);
  const std::size_t coeffs = cloud.sh_coeffs.size() / cloud.size();
  std::vector<std::array<float, 5>> values;
  for (const std::uint32_t i : kept) {
    values.push_back({cloud.opacity_logits[i], cloud.means[i].x, cloud.log_scales[i].y,
                      cloud.quats[i][2], cloud.sh_coeffs[(i + 1) * coeffs - 1].z});
  }
  std::sort(values.begin(), values.end());
  return values;
}

TEST_CASE("pack: a .ply in storage order, whose reference picture is the frame") {
  const PackedScenes scenes;
  tie_depths(scenes.ply());
  const std::string stored = scenes.path("stored.ply");
  const auto reference = [&](const std::string& ply) {
    const std::string picture = scenes.path("reference.exr");
    const Outcome outcome =
        run_streaminggs(joined(joined({"render"}, scenes.view(ply)), {"--out", picture}));
    REQUIRE(outcome.status == 0);
    return bytes_of(picture);
  };
  const auto pack = [&](const Arguments& making) {
    const Outcome outcome = run_streaminggs(
        joined({"pack", scenes.ply(), "--cameras", scenes.cameras(), "--out", stored}, making));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains(stored));
  };
  const GaussianCloud given = read_ply(scenes.ply()).cloud;
  for (const Arguments& making :
       {Arguments{"--config", "exact"},
        with_settings({"--config", "exact"},
                      {"storage.chunk_gaussians=5", "storage.store_invisible=true"})}) {
    const Simulation simulation(joined(scenes.view(scenes.ply()), making));
    const Json& image = simulation.views()[0]["image"];
    CHECK(image["psnr_db"].is_null());
    REQUIRE(image["file_order"]["pixels"] > 0);  // so that the order of storage shows
    pack(making);
    CHECK(reference(stored) == simulation.frame(0));
    const Image in_storage = read_image(scenes.path("reference.exr"));
    CHECK(reference(scenes.ply()) != simulation.frame(0));
    const Image in_file = read_image(scenes.path("reference.exr"));
    CHECK(image["file_order"]["pixels"] == differing_pixels(in_storage, in_file));
    CHECK(image["file_order"]["psnr_db"].get<double>() == Approx(psnr_db(in_storage, in_file)));
    CHECK(image["file_order"]["max_abs_error"].get<double>() ==
          Approx(max_abs_error(in_storage, in_file)));
    // The very values: sorted, those of one are those of the other.
    const bool all = making.size() > 2;
    CHECK(sorted_values(read_ply(stored).cloud, true) == sorted_values(given, all));
  }
  // Said of a single pixel too.
  const Outcome pixel =
      run_streaminggs({"simulate", scenes.ply(), "--cameras", scenes.cameras(), "--view", "2",
                       "--size", "1x1", "--verbose", "--out", scenes.path("pixel")});
  CHECK_THAT(pixel.out, Contains("\n  ties of depth in the file's order: 1 pixels of the"));
  // What an encoding that loses decodes to is not always what floats of a file lead to.
  const Arguments half = {"--config", "exact", "--set", "storage.encoding=half"};
  const Simulation encoded(joined(scenes.view(scenes.ply()), half));
  pack(half);
  std::ofstream(scenes.path("frame.exr"), std::ios::binary) << encoded.frame(0);
  static_cast<void>(reference(stored));
  CHECK(max_abs_error(read_image(scenes.path("reference.exr")),
                      read_image(scenes.path("frame.exr"))) < 1e-3);
}

TEST_CASE("pack: the file's order is not known of a packed scene, and does not show without ties") {
  const PackedScenes scenes;
  const Simulation direct(scenes.view(scenes.ply()));
  const Json& equal = direct.views()[0]["image"]["file_order"];
  CHECK(equal["psnr_db"].is_null());
  CHECK(equal["max_abs_error"] == 0);
  CHECK(equal["pixels"] == 0);
  REQUIRE(scenes.pack({"--config", "exact"}).status == 0);
  const Simulation packed(scenes.view(scenes.packed()));
  CHECK(packed.views()[0]["image"].contains("file_order"));
  CHECK(packed.views()[0]["image"]["file_order"].is_null());
}

// Of 1,000 to 999,999.
std::string with_comma(std::size_t number) {
  const std::string digits = std::to_string(number);
  return digits.substr(0, digits.size() - 3) + "," + digits.substr(digits.size() - 3);
}

TEST_CASE("pack: info says what the file holds, as pack did") {
  const PackedScenes scenes;
  const Outcome packed =
      scenes.pack(joined({"--config", "exact", "--set", "storage.encoding=vq_packed"}, kQuantised));
  REQUIRE(packed.status == 0);
  const Outcome info = run_streaminggs({"info", scenes.packed()});
  REQUIRE(info.status == 0);
  const std::size_t stored = scenes.visible();
  REQUIRE(stored < 4000);
  for (const std::string& line :
       {std::string("scene                     outdoor\n"),
        "gaussians stored          " + with_comma(stored) + " of 4,000\n",
        std::string("second halves             vq_packed, 8 B each\n"),  // 4 encoded, a scale
        std::string("codebook rotation         70 entries x 4 words, 1,120 B\n"),
        std::string("codebook sh               30 entries x 45 words, 5,400 B\n"),
        "region first_halves       " + with_comma(16 * stored) + " B\n",
        std::string("storage order             by chunks, for machine exact: ")}) {
    INFO(line << "\n" << packed.out << info.out);
    CHECK(packed.out.find(line) != std::string::npos);
    CHECK(info.out.find(line) != std::string::npos);
  }
  CHECK_THAT(info.out, Contains("version     5\n") && Contains("checksum"));
  CHECK_THAT(packed.out, Contains("packed in") && Contains("weighted by 5 cameras"));
  const Outcome of_scene = run_streaminggs({"info", scenes.ply()});
  CHECK(of_scene.status == 0);
  CHECK_THAT(of_scene.out, Contains("median opacity"));
}

// Status 2 and one line on stderr that holds `words`.
void check_packed_refused(const Arguments& arguments, const std::vector<std::string>& words) {
  const Outcome outcome = run_streaminggs(arguments);
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  for (const std::string& word : words) CHECK_THAT(outcome.err, Contains(word));
}

TEST_CASE("pack: what a packed scene cannot be used for is refused") {
  const PackedScenes scenes;
  const std::string& file = scenes.packed();
  REQUIRE(scenes.pack(joined({"--config", "exact", "--set", "storage.encoding=vq"}, kQuantised))
              .status == 0);
  const Arguments simulate = joined({"simulate"}, scenes.view(file));
  const Arguments out = {"--out", scenes.path("out")};
  check_packed_refused(joined(joined(simulate, out), {"--config", "paper"}),
                       {file, "stored by chunks", "machine paper reads", "--config exact"});
  const std::string by_file = scenes.path("by_file.sgs");
  REQUIRE(run_streaminggs({"pack", scenes.ply(), "--config", "gscore", "--out", by_file}).status ==
          0);
  check_packed_refused(
      joined(joined({"simulate"}, scenes.view(by_file)), joined(out, {"--config", "gscore_boxes"})),
      {by_file, "stored by file", "gscore with culling.by=chunk_boxes reads",
       ": take --set culling.by=gaussians, or pack"});
  check_packed_refused({"render", file, "--cameras", scenes.cameras(), "--ordering", "paper",
                        "--out", scenes.path("out.png")},
                       {file, "stored by chunks", "machine paper reads"});
  check_packed_refused(joined(joined(simulate, out), {"--set", "sram.codebook_bytes=1000"}),
                       {"sram.codebook_bytes: 1000 bytes are there", "30 entries"});
  check_packed_refused(joined(joined(simulate, out), {"--weigh-by", "0"}), {"--weigh-by", file});
  check_packed_refused(joined(joined(simulate, out), {"--drop-invalid"}), {"--drop-invalid", file});
  check_packed_refused(joined({"simulate", file}, out), {file, "--cameras FILE is needed"});
  check_packed_refused({"pack", file, "--out", scenes.path("b.sgs")},
                       {file, "expected a scene (.ply"});
  check_packed_refused({"pack", scenes.ply(), "--out", scenes.path("b.bin")}, {"b.bin", ".sgs"});
  check_packed_refused({"pack", scenes.ply(), "--out", file + "/b.sgs"}, {file + "/b.sgs"});
  CHECK_FALSE(std::filesystem::exists(scenes.path("out")));
}

TEST_CASE("pack: what is said of storage is as the file has it, or a preset's") {
  const PackedScenes scenes;
  REQUIRE(scenes.pack({"--config", "paper_no_vq", "--set", "storage.encoding=half"}).status == 0);
  const std::string& file = scenes.packed();
  const ScratchFolder configs;
  const Arguments simulate =
      joined(joined({"simulate"}, scenes.view(file)), {"--out", scenes.path("out"), "--config"});
  const auto with = [&](const char* set) { return Arguments{"paper_no_vq", "--set", set}; };
  for (const auto& [more, words] : std::vector<std::pair<Arguments, std::vector<std::string>>>{
           {with("storage.encoding=raw"),
            {"--set storage.encoding=raw: storage.encoding: got raw, expected half: " + file}},
           {with("storage.voxel_size=0.4"), {"storage.voxel_size: got 0.4, expected 2.0"}},
           {with("storage.vq.iterations=0"), {"storage.vq.iterations: got 0, expected "}},
           {with("storage.store_invisible=true"), {"got true, expected false"}},
           {{configs.write("c.json", R"({"machine": "paper", "storage": {"encoding": "vq"}})")},
            {"c.json: storage.encoding: got vq, expected half"}}}) {
    check_packed_refused(joined(simulate, more), words);
    CHECK_FALSE(std::filesystem::exists(scenes.path("out")));
  }
  for (const auto& [more, word] : std::vector<std::pair<Arguments, std::string>>{
           {with("hfus=1"), "storage from scene.sgs: half, voxels of 2 (preset paper_no_vq: raw)"},
           {{"paper"}, "storage from scene.sgs: half, voxels of 2 (preset paper: vq)"},
           {with("storage.encoding=half"), "storage from scene.sgs: half, voxels of 2\n"},
           {with_settings({"paper"}, {"storage.encoding=half", "storage.voxel_size=0"}),
            "storage from scene.sgs: half, voxels of 2\n"},
           {{"paper", "--verbose"}, "encoding not known: packed"},
           {{"paper"}, "are against the decoded scene"}}) {
    INFO(word);
    const Outcome outcome = run_streaminggs(joined(simulate, more));
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains(word));
  }
}

TEST_CASE("pack: a damaged file is refused by every command") {
  const PackedScenes scenes;
  REQUIRE(scenes.pack({}).status == 0);
  std::string bytes = bytes_of(scenes.packed());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  std::ofstream(scenes.packed(), std::ios::binary) << bytes;
  for (const char* command : {"simulate", "render"}) {
    check_packed_refused(
        joined(joined({command}, scenes.view(scenes.packed())), {"--out", scenes.path("out.png")}),
        {scenes.packed(), "checksum"});
  }
  check_packed_refused({"info", scenes.packed()}, {scenes.packed(), "checksum"});
}

TEST_CASE("pack: --print-config shows what the image decides") {
  const PackedScenes scenes;
  REQUIRE(scenes
              .pack(joined(with_settings({"--config", "exact"}, {"storage.encoding=vq_packed",
                                                                 "storage.chunk_gaussians=24"}),
                           kQuantised))
              .status == 0);
  const Arguments print = {"simulate", scenes.packed(), "--set", "hfu.cost=counted",
                           "--print-config"};
  check_packed_refused(print, {"sram.codebook_bytes: 0 bytes are there"});
  const Outcome shown = run_streaminggs(with_settings(print, {"sram.codebook_bytes=65536"}));
  INFO(shown.err);
  REQUIRE(shown.status == 0);
  const Json config = Json::parse(shown.out);
  CHECK(config["storage"]["encoding"] == "vq_packed");
  CHECK(config["storage"]["chunk_gaussians"] == 24);
  CHECK(config["storage"]["vq"]["rotation_entries"] == 70);
  CHECK(config["hfu"]["ffu_macs"] == 0);  // of the machine, which leaves it open
}

}  // namespace
}  // namespace sgs::test

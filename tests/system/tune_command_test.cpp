// `streaminggs tune` on small scenes: files, checkpoints, what it refuses.
#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/system/shell.h"

namespace sgs::test {
namespace {

struct TuneRow {
  std::string line;
  std::vector<std::string> words;
};

constexpr const char* kTune = "$SG tune $B --boundary --steps 30 --test-every 15 ";
constexpr const char* kQuantise =
    "$SG tune $B --quantise --steps 30 --test-every 15 --reassign-every 10 "
    "--set storage.vq.dc_entries=32 ";

constexpr const char* kStreaming =
    "$SG tune $B --streaming --config exact --steps 30 --test-every 15 --price 0.5 ";

TEST_CASE("tune: a scene whose centres rest, a log that begins with the scene as given") {
  for (const TuneRow& row : std::vector<TuneRow>{
           {"--out t.ply --log l.csv",
            {"no photographs: the scene's own reference pictures, 4 views, 1 to test with",
             "step,seconds,loss,gaussians,test_psnr_db,test_ssim,reference_psnr_db,"
             "misordered_gaussians,misordered_pixels,l_cbp\n0,",
             "\n15,", "\n30,", "gaussians                 300\n"}},
           {"--out t.ply --log l.csv --between 5 --beta 0.5 --misordered-in pixel",
            {"5 views between the cameras, 5 to test with"}},
           {"--out t.ply --log l.csv --set storage.voxel_size=0.5 --visit-memory 0",
            {"in voxels of 0.5", "0.0 MB kept"}}}) {
    const ScratchFolder scratch;
    const ShellOutcome made = shell(scratch, kTune + row.line + " && cat l.csv && $SG info t.ply");
    INFO(row.line << '\n' << made.out << made.err);
    CHECK(made.status == 0);
    for (const std::string& word : row.words) {
      INFO(word);
      CHECK(made.out.find(word) != std::string::npos);
    }
  }
}

TEST_CASE("tune: visits are told of in paper order, where there are some") {
  for (const auto& [config, has_visits] :
       {std::pair{"paper", true}, std::pair{"exact_vq", false}}) {
    const ScratchFolder scratch;
    const ShellOutcome made = shell(
        scratch, std::string("$SG tune $B --quantise --steps 2 --out t.sgs --config ") + config);
    INFO(config << '\n' << made.out << made.err);
    CHECK(made.status == 0);
    CHECK((made.out.find("MB kept\n") != std::string::npos) == has_visits);
  }
}

TEST_CASE("tune: the pictures of another scene as the target") {
  const ScratchFolder scratch;
  const ShellOutcome made = shell(
      scratch,
      "$SG tune $B --boundary --beta 9 --steps 30 --out t.ply >t && printf "
      "'[{\"id\":0,\"img_name\":\"a\",\"width\":32,\"height\":18,\"position\":[0,0,-5],"
      "\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"fx\":32,\"fy\":32}]' >c.json && for target in "
      "t.ply ${B%% *}; do $SG tune t.ply --boundary --cameras c.json --steps 1 --target "
      "$target --out u.ply --log l.csv && sed -n 2p l.csv | cut -d, -f7; done");
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out.find("reference pictures of t.ply, 1 views") != std::string::npos);
  CHECK(made.out.find("reference pictures of builtin:object?n=300, 1 views") != std::string::npos);
  // In the reference order the tuned scene is its own target, and not the given one.
  const std::size_t first = made.out.find("kept\n") + 5, second = made.out.rfind("kept\n") + 5;
  REQUIRE(first != second);
  CHECK(std::stod(made.out.substr(first)) > 90);
  CHECK(std::stod(made.out.substr(second)) < 60);
}

TEST_CASE("tune: codebooks learned, packed for the machine of the configuration") {
  for (const char* config : {"paper", "exact_vq", "exact_vq_packed"}) {
    const ScratchFolder scratch;
    const std::string with = std::string("--config ") + config;
    const ShellOutcome made =
        shell(scratch, kQuantise + with +
                           " --out q.sgs --log l.csv && cat l.csv && $SG info q.sgs && "
                           "printf '[{\"id\":0,\"img_name\":\"a\",\"width\":32,\"height\":18,"
                           "\"position\":[0,0,-5],\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"fx\":32,"
                           "\"fy\":32}]' >c.json && $SG simulate q.sgs --cameras c.json " +
                           with);
    INFO(made.out << made.err);
    CHECK(made.status == 0);
    for (const char* word : {"before codebooks", "test_ssim,reference_psnr_db,reassigned\n0,",
                             "\n15,", "\n30,", " of 300\n"}) {
      INFO(word);
      CHECK(made.out.find(word) != std::string::npos);
    }
  }
}

TEST_CASE("tune: what is cheaper to stream") {
  const ScratchFolder scratch;
  const ShellOutcome made = shell(
      scratch, std::string(kStreaming) + "--out t.ply --log l.csv && cat l.csv && $SG info t.ply");
  INFO(made.out << made.err);
  CHECK(made.status == 0);
  for (const char* word :
       {"in chunks of 8", "test_ssim,stored,fetches\n0,", "\n15,", "\n30,",
        " dB worse than before the first step\n", "gaussians                 300\n"}) {
    INFO(word);
    CHECK(made.out.find(word) != std::string::npos);
  }
}

TEST_CASE("tune: what is resumed ends as what was never stopped, bit for bit") {
  for (const std::string tune : {kTune, kQuantise, kStreaming}) {
    const std::string extension = tune == kQuantise ? ".sgs" : ".ply";
    const ScratchFolder scratch;
    const ShellOutcome made =
        shell(scratch, tune + "--out a" + extension + " --checkpoint 20 && cp a" + extension +
                           ".checkpoint mid && " + tune + "--out b" + extension +
                           " --resume mid && cmp a" + extension + " b" + extension);
    INFO(made.out << made.err);
    CHECK(made.status == 0);
  }
}

TEST_CASE("tune: a checkpoint goes on with other steps and another rate") {
  const auto lines_of = [](const std::string& steps, const std::string& rate) {
    return "--steps " + steps + " --rate " + rate;
  };
  for (const std::string tune :
       {"$SG tune $B --boundary --out a.ply ", "$SG tune $B --quantise --out a.sgs ",
        "$SG tune $B --streaming --config exact --out a.ply "}) {
    const ScratchFolder scratch;
    const std::string a = tune.find("a.sgs") == std::string::npos ? "a.ply" : "a.sgs";
    const std::string first = tune + lines_of("30", "0.5") + " --checkpoint 20 >out && cp " + a +
                              ".checkpoint mid && cp " + a + " whole && ";
    // Longer, slower, and as it was: another scene but for the last.
    const ShellOutcome made = shell(
        scratch, first + "for p in '" + lines_of("31", "0.5") + "' '" + lines_of("30", "0.25") +
                     "' '" + lines_of("30", "0.5") + "'; do " + tune +
                     "$p --resume mid || exit 1; cmp -s " + a + " whole; echo cmp $?; done");
    INFO(made.out << made.err);
    CHECK(made.status == 0);
    std::vector<std::string> told;
    std::istringstream out(made.out);
    for (std::string line; std::getline(out, line);) {
      if (line.rfind("cmp ", 0) == 0 || line.rfind("resumed ", 0) == 0) told.push_back(line);
    }
    const std::string behind = "resumed                   behind step 20 with ";
    const std::string until = ", until there with " + lines_of("30", "0.5");
    CHECK((told == std::vector<std::string>{behind + lines_of("31", "0.5") + until, "cmp 1",
                                            behind + lines_of("30", "0.25") + until, "cmp 1",
                                            "cmp 0"}));
  }
}

TEST_CASE("tune: what learned too fast goes on with a smaller rate") {
  const ScratchFolder scratch;
  const std::string tune =
      "$SG tune 'builtin:object?n=500' --boundary --size 48x32 --between 4 --beta 1e9 --steps 60 "
      "--out t.ply ";
  const ShellOutcome made =
      shell(scratch, tune + "--rate 1000; echo status $?; " + tune +
                         "--rate 1 --resume t.ply.checkpoint && $SG info t.ply && " + tune +
                         "--rate 1000 --resume t.ply.checkpoint; echo status $?");
  INFO(made.out << made.err);
  CHECK(made.out.find("status 1\n") != made.out.rfind("status 1\n"));
  CHECK(made.out.find("gaussians                 500\n") != std::string::npos);
  const std::string failed =
      "than a scene may hold; the last good state is in t.ply.checkpoint; to go on: --resume it "
      "with a smaller --rate\n";
  CHECK(made.err.find(failed) != made.err.rfind(failed));
}

TEST_CASE("tune: Ctrl-C saves, and says how to go on") {
  const ScratchFolder scratch;
  const ShellOutcome made = shell(
      scratch,
      "$SG tune $B --boundary --out s.ply --steps 1000000 & p=$!; sleep 2; kill -INT $p; wait $p; "
      "echo status $?; ls");
  INFO(made.out << made.err);
  CHECK(made.out.find("status 130") != std::string::npos);
  CHECK(made.out.find("s.ply\ns.ply.checkpoint\n") != std::string::npos);
  CHECK(made.err.find("to go on: --resume s.ply.checkpoint") != std::string::npos);
}

TEST_CASE("tune: refusals") {
  const std::string checkpoint = std::string(kTune) + "--out s.ply --checkpoint 20 >t && ";
  for (const TuneRow& row : std::vector<TuneRow>{
           {"$SG tune $B --out t.ply", {"got nothing to tune for"}},
           {"$SG tune $B --boundary --quantise --out t.ply", {"got several things to tune for"}},
           {"$SG tune $B --quantise --out t.ply", {"--out", "t.ply", ".sgs"}},
           {"$SG tune $B --quantise --out t.sgs --config paper_no_vq",
            {"--quantise", "storage.encoding raw", "vq or vq_packed"}},
           {"$SG tune $B --quantise --out t.sgs --beta 1", {"--beta", "--boundary"}},
           {"$SG tune $B --boundary --out t.ply --reassign-every 9",
            {"--reassign-every", "--quantise"}},
           {"$SG tune $B --streaming --out t.ply", {"--streaming", "machine paper", "exact order"}},
           {"$SG tune $B --boundary --out t.ply --price 1", {"--price", "--streaming"}},
           {"$SG tune nofile.ply --boundary --out t.ply", {"nofile.ply: no such file"}},
           {"$SG tune $B --boundary --out t.txt", {"--out", "t.txt", ".ply"}},
           {"$SG tune $S --boundary --out t.ply --data nofolder", {"nofolder: no such folder"}},
           {"$SG tune $B --boundary --out t.ply --data d", {"--size", "data set"}},
           {"$SG tune $S --boundary --out t.ply --data d --target $S", {"--target", "data set"}},
           {"$SG tune $S --boundary --out t.ply --data d --log d/transforms_train.json",
            {"d/transforms_train.json: is the same file as the input"}},
           {"$SG tune $B --boundary --out t.ply --downscale 2", {"--downscale", "--data"}},
           {"$SG tune $B --boundary --out t.ply --target nofile.ply", {"nofile.ply: no such file"}},
           {"$SG tune $B --boundary --out t.ply --config exact",
            {"--boundary", "machine exact", "paper order"}},
           {"$SG tune $B --quantise --out t.sgs --config exact_vq --set rendering.precision=fp16",
            {"--quantise", "machine exact", "rendering.precision fp32"}},
           {"$SG tune $B --streaming --out t.ply --config exact --set "
            "merge.on_overflow=blend_early",
            {"--streaming", "machine exact", "rendering.precision fp32"}},
           {"$SG tune $B --streaming --out t.ply --config exact --visit-memory 9",
            {"--visit-memory", "paper order"}},
           {"$SG tune $B --boundary --out t.ply --beta -1", {"--beta", "-1"}},
           {"$SG tune $B --boundary --out t.ply --steps 0", {"--steps", "'0'", "from 1"}},
           {"$SG tune $B --boundary --out t.ply --rate 0", {"--rate", "'0'"}},
           {"$SG tune $B --boundary --out t.ply --misordered-in x", {"--misordered-in", "x"}},
           {ply_of({"0 0 5"}) + "; $SG tune a.ply --boundary --out t.ply",
            {"a.ply: brings no cameras"}},
           {ply_of({"0 0 5"}, -9) +
                "; printf '[{\"id\":0,\"img_name\":\"a\",\"width\":16,\"height\":16,\"position\":"
                "[0,0,0],\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"fx\":16,\"fy\":16}]' >c.json; "
                "$SG tune a.ply --boundary --out t.ply --cameras c.json",
            {"a.ply: holds no Gaussian that a view could show"}},
           {"$SG tune $B --boundary --out t.ply --resume nofile", {"nofile: cannot be opened"}},
           {checkpoint + "$SG tune $B --boundary --seed 2 --out t.ply --resume s.ply.checkpoint",
            {"is of 'tune builtin:object?n=300", "--seed 1", "expected", "--seed 2"}},
           {checkpoint + "$SG tune $B --boundary --steps 19 --out t.ply --resume s.ply.checkpoint",
            {"s.ply.checkpoint: has done 20 steps, expected up to 19"}},
           {"echo '{\"machine\":\"paper\"}' >m.json; " + std::string(kTune) +
                "--config m.json --out s.ply --checkpoint 20 >t && echo "
                "'{\"machine\":\"paper\",\"hfu\":{}}' >m.json; " +
                kTune + "--config m.json --out t.ply --resume s.ply.checkpoint",
            {"s.ply.checkpoint: a file that it was made from holds something else"}},
           {checkpoint + kQuantise + "--out t.sgs --resume s.ply.checkpoint",
            {"is of 'tune builtin:object?n=300", "--boundary", "expected", "--quantise"}}}) {
    const ScratchFolder scratch;
    write_nerf_synthetic(scratch.path("d"), made_scene());
    check_refused(scratch, row.line, row.words);
  }
}

}  // namespace
}  // namespace sgs::test

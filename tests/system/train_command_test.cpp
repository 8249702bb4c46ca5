// `streaminggs train` on a small data set made here: files, checkpoints, what it refuses.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/system/shell.h"

namespace sgs::test {
namespace {

constexpr const char* kTrain = "$SG train d --steps 40 --gaussians 300 --test-every 20 ";

void make_dataset(const ScratchFolder& scratch) {
  write_nerf_synthetic(scratch.path("d"), made_scene());
}

TEST_CASE("train: a scene, a log with a line for each look at the test views") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  const ShellOutcome made = shell(
      scratch, kTrain + std::string("--out s.ply --log l.csv && $SG info s.ply && cat l.csv"));
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  for (const char* words : {"gaussians                 300\n", "sh degree                 3\n",
                            "step,seconds,loss,gaussians,test_psnr_db,test_ssim\n20,", "\n40,"}) {
    INFO(words);
    CHECK(made.out.find(words) != std::string::npos);
  }
}

TEST_CASE("train and tune: pictures of test views as it goes") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  const ShellOutcome made =
      shell(scratch,
            kTrain + std::string("--out s.ply --pictures p --picture-views 1 >t && ls p && "
                                 "for way in '--boundary --out t.ply' '--streaming --config exact "
                                 "--out t.ply' '--quantise --set storage.vq.dc_entries=32 --out "
                                 "t.sgs'; do $SG tune s.ply $way --data d --steps 4 "
                                 "--test-every 2 --pictures q >t || exit 1; done; ls q"));
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out ==
        "view_1_photograph.png\nview_1_step_000020.png\nview_1_step_000040.png\n"
        "view_0_photograph.png\nview_0_step_000000.png\nview_0_step_000002.png\n"
        "view_0_step_000004.png\n");
}

TEST_CASE("train: what is resumed ends as what was never stopped, bit for bit") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  const std::string train = kTrain;
  const ShellOutcome made =
      shell(scratch, train + "--out a.ply --checkpoint 25 && cp a.ply.checkpoint mid && " + train +
                         "--out b.ply --resume mid && cmp a.ply b.ply");
  INFO(made.out << made.err);
  CHECK(made.status == 0);
}

TEST_CASE("train: Ctrl-C and a request to end save, and say how to go on") {
  for (const std::string signal : {"INT", "TERM"}) {
    const ScratchFolder scratch;
    make_dataset(scratch);
    const ShellOutcome made =
        shell(scratch,
              "$SG train d --out s.ply --gaussians 300 --steps 100000 & p=$!; sleep 3; "
              "kill -" +
                  signal + " $p; wait $p; echo status $?; ls");
    INFO(made.out << made.err);
    CHECK(made.out.find("status 130") != std::string::npos);
    CHECK(made.out.find("s.ply\ns.ply.checkpoint\n") != std::string::npos);
    CHECK(made.err.find("to go on: --resume s.ply.checkpoint") != std::string::npos);
  }
}

TEST_CASE("train: what fails on the way leaves a checkpoint that ends as what never failed") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  const std::string train = kTrain;
  const ShellOutcome made =
      shell(scratch, "mkdir -p p/view_0_step_000020.png; " + train +
                         "--out a.ply --pictures p; echo status $?; " + train +
                         "--out a.ply --resume a.ply.checkpoint >t && " + train +
                         "--out b.ply >t && cmp a.ply b.ply && echo same");
  INFO(made.out << made.err);
  CHECK(made.out.find("status 1\n") != std::string::npos);
  CHECK(made.out.find("same\n") != std::string::npos);
  CHECK(made.err.find("p/view_0_step_000020.png") != std::string::npos);
  CHECK(made.err.find("; the last good state is in a.ply.checkpoint") != std::string::npos);
}

TEST_CASE("train, tune, photographs: pictures and cameras smaller than the files") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  const std::string half = "--downscale 2 ";
  const ShellOutcome made = shell(
      scratch,
      "$SG photographs d --downscale 2.5 --out p && grep -o '\"width\": *[0-9]*\\|\"height\": "
      "*[0-9]*\\|\"fx\": *[0-9.]*' p/cameras.json | tr -d ' ' | sort | uniq -c && " +
          std::string(kTrain) + half +
          "--out s.ply --checkpoint 25 --pictures q && cp "
          "s.ply.checkpoint mid && " +
          kTrain + half +
          "--out t.ply --resume mid && cmp s.ply "
          "t.ply && head -c 24 q/view_0_step_000040.png | tail -c 8 | od -An -tu1 && $SG tune "
          "s.ply --boundary --data d " +
          half + "--steps 4 --out u.ply --checkpoint 2 && $SG tune s.ply --boundary --data d " +
          half + "--steps 4 --out v.ply --resume u.ply.checkpoint && cmp u.ply v.ply");
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  for (const char* words :
       {"3 \"width\":26\n", "3 \"height\":19\n", "3 \"fx\":24.375\n", "0  32   0   0   0  24\n"}) {
    INFO(words);
    CHECK(made.out.find(words) != std::string::npos);
  }
}

TEST_CASE("train: what it starts from is said") {
  const ScratchFolder scratch;
  make_dataset(scratch);
  write_colmap_text(scratch.path("c"), made_scene());
  const ShellOutcome made =
      shell(scratch, std::string(kTrain) +
                         "--background white --out s.ply && $SG train c --steps 5 --gaussians 300 "
                         "--out t.ply");
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out.find(" 300 of 300 random points, the data set brings none\n") !=
        std::string::npos);
  CHECK(made.out.find(" 5 of 5 points of the data set\n") != std::string::npos);
}

TEST_CASE("photographs: frames beside them are as near as the log of training says") {
  const ScratchFolder scratch;
  write_cameras_json(scratch.path("d"), made_scene());
  const ShellOutcome made = shell(
      scratch,
      "$SG photographs d --out p && ls p && $SG train d --steps 60 --gaussians 300 "
      "--out s.ply --log l.csv >t && $SG simulate s.ply --cameras p/cameras.json --view all "
      "--set framebuffer=rgb32f --out o >t && for v in 0 1; do $SG compare "
      "o/view_$v/frame.exr p/view_$v.exr; done && echo logged $(tail -n 1 l.csv | cut -d, -f5)");
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out.find("2 test views written to p\ncameras.json\nview_0.exr\nview_1.exr\n") !=
        std::string::npos);
  const auto number_behind = [&](const std::string& word, std::size_t from) {
    return std::stod(made.out.substr(made.out.find(word, from) + word.size()));
  };
  const std::size_t second = made.out.rfind("psnr_db ");
  const double mean = (number_behind("psnr_db ", 0) + number_behind("psnr_db ", second)) / 2;
  CHECK(mean == Approx(number_behind("logged ", 0)).margin(1e-3));
}

TEST_CASE("photographs: refusals") {
  struct Row {
    std::string line;
    std::vector<std::string> words;
  };
  for (const Row& row :
       std::vector<Row>{{"$SG photographs nofolder --out p", {"nofolder: no such folder"}},
                        {"$SG photographs d --out d", {"d/cameras.json"}},
                        {"$SG photographs n --out ./n/", {"./n/ is the data set itself"}},
                        {"$SG photographs d --out p --downscale 0.5", {"--downscale", "0.5"}},
                        {"$SG photographs d", {"--out"}}}) {
    const ScratchFolder scratch;
    write_cameras_json(scratch.path("d"), made_scene());
    write_nerf_synthetic(scratch.path("n"), made_scene());
    check_refused(scratch, row.line, row.words);
  }
}

TEST_CASE("train: refusals") {
  struct Row {
    std::string line;
    std::vector<std::string> words;  // on stderr
  };
  const std::string checkpoint = std::string(kTrain) + "--out s.ply --checkpoint 25 >t && ";
  for (const Row& row : std::vector<Row>{
           {"$SG train nofolder --out s.ply", {"nofolder: no such folder"}},
           {"$SG train d/transforms_train.json --out s.ply", {"is a file, expected a folder"}},
           {"i=$(ls d/train/*.png | tail -1); head -c 100 $i >cut; mv cut $i; $SG train d --out "
            "s.ply",
            {".png"}},
           {"$SG train d --out ''", {"--out", "got nothing"}},
           {"$SG train d --out s.sgs", {"--out", "s.sgs", ".ply"}},
           {"$SG train d --out s.ply --log s.ply.checkpoint", {"s.ply.checkpoint"}},
           {"mkdir s.ply.checkpoint; $SG train d --out s.ply", {"s.ply.checkpoint", "folder"}},
           {"$SG train d --out s.ply --steps 0", {"--steps", "0"}},
           {"$SG train d --out s.ply --downscale 0.99", {"--downscale", "0.99"}},
           {"$SG train d --out s.ply --log d/transforms_test.json",
            {"d/transforms_test.json: is the same file as the input"}},
           {"$SG train d --out s.ply --log ./d/transforms_val.json",
            {"d/transforms_val.json: is the same file as the input"}},
           {"$SG train d --out s.ply --log d/train/shot_04.png",
            {"d/train/shot_04.png: is the same file as the input"}},
           {"sed -i 's/\"frames\": \\[/\"frames\": [], \"was\": [/' d/transforms_test.json; $SG "
            "train d "
            "--out s.ply",
            {"d/transforms_test.json: frames: got none, expected one view or more to test with"}},
           {"$SG train d --out s.ply --growth none", {"--growth", "none"}},
           {"$SG train d --out s.ply --picture-views 1", {"--picture-views", "--pictures"}},
           {"$SG train d --out s.ply --pictures p --picture-views 9",
            {"--picture-views", "got 9", "expected 0 .."}},
           {"$SG train d --out s.ply --resume nofile", {"nofile: cannot be opened"}},
           {"$SG train d --out s.ply --resume d/transforms_train.json",
            {"d/transforms_train.json", "expected a checkpoint"}},
           {checkpoint + "head -c 5000 s.ply.checkpoint >c; " + kTrain + "--out t.ply --resume c",
            {"c: was cut off or changed"}},
           {checkpoint + "$SG train d --steps 41 --out t.ply --resume s.ply.checkpoint",
            {"s.ply.checkpoint: is of 'train d --steps 40", "expected 'train d --steps 41"}},
           {checkpoint + kTrain + "--downscale 2 --out t.ply --resume s.ply.checkpoint",
            {"expected 'train d --downscale 2 --steps 40"}},
           {"$SG train opaque --out s.ply --background white", {"--background", "white", "opaque"}},
           {checkpoint + "cp d/train/shot_04.png d/train/shot_03.png; " + kTrain +
                "--out t.ply --resume s.ply.checkpoint",
            {"s.ply.checkpoint: a file that it was made from holds something else"}},
           {checkpoint + kTrain + "--out s.ply.checkpoint --resume s.ply.checkpoint",
            {"s.ply.checkpoint"}},
       }) {
    const ScratchFolder scratch;
    make_dataset(scratch);
    scratch.write("d/transforms_val.json", "{}");
    write_colmap_text(scratch.path("opaque"), made_scene());
    check_refused(scratch, row.line, row.words);
  }
}

TEST_CASE("cameras: data sets, transforms.json and cameras.json draw the same pictures") {
  const ScratchFolder scratch;
  PhotographedScene scene = made_scene();
  scene.principal = {28.5, 26};
  write_transforms(scratch.path("t"), scene);
  write_colmap_binary(scratch.path("c"), scene);
  scene.principal = {32, 24};
  write_transforms(scratch.path("m"), scene);
  write_cameras_json(scratch.path("j"), scene);
  const ShellOutcome made = shell(
      scratch,
      "rm -r t/images c/images; n=0; for cameras in t t/transforms.json c c/sparse/0 m "
      "j/cameras.json "
      "j; do n=$((n + 1)); $SG render 'builtin:object?n=300' --cameras $cameras --view 3 --out "
      "$n.pfm || exit 1; done; cmp 1.pfm 2.pfm && cmp 3.pfm 4.pfm && cmp 5.pfm 6.pfm && cmp 6.pfm "
      "7.pfm && ! cmp -s 1.pfm 5.pfm && $SG compare 1.pfm 3.pfm && $SG simulate "
      "'builtin:object?n=300' --cameras t --view 3 --out o >said && grep -o '\"c[xy]_px\": "
      "[0-9.]*' o/view_3/report.json | sort -u");
  INFO(made.out << made.err);
  CHECK(made.status == 0);
  CHECK(made.out.find("\"cx_px\": 28.5\n\"cy_px\": 26.0\n") != std::string::npos);
  const std::size_t psnr = made.out.find("psnr_db ");
  REQUIRE(psnr != std::string::npos);
  const std::string db = made.out.substr(psnr + 8, made.out.find('\n', psnr) - psnr - 8);
  CHECK((db == "inf" || std::stod(db) > 90));
}

TEST_CASE("cameras, info, train: what is undistorted, masked or not read is said once") {
  const ScratchFolder scratch;
  write_transforms(scratch.path("d"), made_scene());
  std::string text = bytes_of(scratch.path("d/transforms.json"));
  text.replace(text.find("\"k1\": 0.0"), 9, "\"aabb_scale\": 4, \"k1\": -0.1");
  text.insert(1, "\"mask_path\": \"images/shot_00.jpg\", ");
  write_file(scratch.path("d"), "transforms.json", text);
  const ShellOutcome made = shell(
      scratch,
      "$SG info d >a && $SG train d --steps 2 --gaussians 300 --out s.ply >b && $SG tune s.ply "
      "--boundary --data d --steps 2 --out t.ply >c && for said in a b c; do grep -c "
      "'^undistorted .*10 views (OPENCV)' $said; grep -c '^masks .*of 10 views' $said; grep -c "
      "'^not read .*aabb_scale$' $said; done; $SG render s.ply --cameras d --out p.pfm; $SG info "
      "d/transforms.json");
  INFO(made.out << made.err);
  CHECK(made.status == 0);
  CHECK(made.out.find("1\n1\n1\n1\n1\n1\n1\n1\n1\nd: 10 cameras have a lens (OPENCV) and are drawn "
                      "as pinholes of its focal lengths; not read: aabb_scale\nwritten to "
                      "p.pfm\ncameras ") == 0);
  CHECK(made.out.find("64x48 px (10)\n") != std::string::npos);
}

TEST_CASE("info: an option chooses layout and folder of photographs") {
  const ScratchFolder scratch;
  write_cameras_json(scratch.path("d"), made_scene());
  check_refused(scratch, "touch d/transforms.json; $SG info d",
                {"d: holds transforms.json and cameras.json, expected one of them, or --layout "
                 "transforms or cameras"});
  const ShellOutcome made =
      shell(scratch, "mv d/images d/images_2; $SG info d --layout cameras --images images_2");
  INFO(made.out << made.err);
  CHECK(made.status == 0);
  CHECK(made.out.find("data set                  cameras.json\n") != std::string::npos);
  CHECK(made.out.find("images from               images_2\n") != std::string::npos);
}

}  // namespace
}  // namespace sgs::test

// Which views test: the data set's own, or every 8th by name.
#include <catch2/catch.hpp>
#include <filesystem>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
namespace fs = std::filesystem;

namespace {

// Gives view 0 of the NSVF data set in `folder` another name.
void rename_view(const std::string& folder, const std::string& from, const std::string& to) {
  fs::rename(folder + "/rgb/" + from + ".png", folder + "/rgb/" + to + ".png");
  fs::rename(folder + "/pose/" + from + ".txt", folder + "/pose/" + to + ".txt");
}

std::vector<std::string> test_names(const Dataset& dataset) {
  std::vector<std::string> names;
  for (const int number : views_of(dataset, Split::kTest)) {
    names.push_back(dataset.views[static_cast<std::size_t>(number)].name);
  }
  return names;
}

}  // namespace

TEST_CASE("splits: NSVF tests with 2_, else with 1_, and with every 8th where no name has either") {
  const ScratchFolder scratch;
  write_nsvf_matrix(scratch.path(""), made_scene());
  CHECK(test_names(open_dataset(scratch.path(""))) == std::vector<std::string>{"2_0008", "2_0009"});
  rename_view(scratch.path(""), "2_0008", "1_0008");
  rename_view(scratch.path(""), "2_0009", "0_0009");
  const Dataset two = open_dataset(scratch.path(""));
  CHECK(test_names(two) == std::vector<std::string>{"1_0006", "1_0007", "1_0008"});
  CHECK(two.left_out == 0);
  for (const char* name : {"0006", "0007", "0008"}) {
    rename_view(scratch.path(""), std::string("1_") + name, std::string("0_") + name);
  }
  const Dataset training = open_dataset(scratch.path(""));
  CHECK(training.split_by == SplitBy::kEveryEighth);
  CHECK(test_names(training) == std::vector<std::string>{"0_0000", "0_0008"});
  for (int i = 0; i < 10; ++i) {
    rename_view(scratch.path(""), "0_000" + std::to_string(i), std::to_string(i));
  }
  const Dataset plain = open_dataset(scratch.path(""));
  CHECK(plain.split_by == SplitBy::kEveryEighth);
  CHECK(test_names(plain) == std::vector<std::string>{"0", "8"});
}

TEST_CASE("splits: transforms_train.json alone is split by names, in the order of names") {
  const ScratchFolder scratch;
  write_nerf_synthetic(scratch.path(""), made_scene());
  fs::remove(scratch.path("transforms_test.json"));
  const Dataset dataset = open_dataset(scratch.path(""));
  CHECK(dataset.split_by == SplitBy::kEveryEighth);
  CHECK(test_names(dataset) == std::vector<std::string>{"train/shot_03"});
  CHECK(dataset.views.size() == 7);
}

TEST_CASE("splits: transforms.json that lists names") {
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), made_scene());
  std::string text = bytes_of(scratch.path("transforms.json"));
  const std::string lists =
      R"("train_filenames": ["images/shot_01.jpg", "./images/shot_05.jpg"],
         "val_filenames": ["images/shot_06.jpg"],)";
  text.insert(1, lists);
  scratch.write("transforms.json", text);
  const Dataset validated = open_dataset(scratch.path(""));
  CHECK(validated.split_by == SplitBy::kDataset);
  CHECK(test_names(validated) == std::vector<std::string>{"images/shot_06"});
  CHECK(validated.views.size() == 3);
  CHECK(validated.left_out == 7);
  text.insert(1, R"("test_filenames": ["images/shot_00.jpg", "images/shot_08.jpg"],)");
  scratch.write("transforms.json", text);
  const Dataset tested = open_dataset(scratch.path(""));
  CHECK(test_names(tested) == std::vector<std::string>{"images/shot_00", "images/shot_08"});
  CHECK(tested.left_out == 6);
  // Whatever is in both lists tests; without a list of its own the rest trains.
  const std::string text_alone = bytes_of(scratch.path("transforms.json"));
  std::string both = text_alone;
  both.replace(both.find("shot_08"), 7, "shot_01");
  scratch.write("transforms.json", both);
  CHECK(test_names(open_dataset(scratch.path(""))) ==
        std::vector<std::string>{"images/shot_00", "images/shot_01"});
  std::string rest = text_alone;
  rest.replace(rest.find("train_filenames"), 15, "other_filenames");
  scratch.write("transforms.json", rest);
  CHECK(views_of(open_dataset(scratch.path("")), Split::kTrain).size() == 8);
}

TEST_CASE("splits: none to test with is said with what was to name them") {
  struct Row {
    void (*write)(const std::string& folder, const PhotographedScene& scene);
    const char* file;
    const char* from;
    const char* to;
    const char* words;
  };
  for (const Row& row :
       {Row{write_nerf_synthetic, "transforms_test.json", "\"frames\": [",
            "\"frames\": [], \"was\": [",
            "transforms_test.json: frames: got none, expected one view or more to test with"},
        Row{write_transforms, "transforms.json", "{",
            "{\"train_filenames\": [\"images/shot_01.jpg\"],",
            "transforms.json: test_filenames or val_filenames: got none, expected"},
        Row{write_transforms, "transforms.json", "{", "{\"test_filenames\": [],",
            "transforms.json: test_filenames or val_filenames: got none, expected"}}) {
    const ScratchFolder scratch;
    row.write(scratch.path(""), made_scene());
    CHECK_NOTHROW(require_test_views(open_dataset(scratch.path(""))));
    std::string text = bytes_of(scratch.path(row.file));
    scratch.write(row.file,
                  text.replace(text.find(row.from), std::string(row.from).size(), row.to));
    const Dataset dataset = open_dataset(scratch.path(""));
    CHECK_THAT(input_error_of([&] { require_test_views(dataset); }),
               Catch::Matchers::Contains(scratch.path(row.words)));
  }
}

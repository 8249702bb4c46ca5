// Which views test: the data set's own, or every 8th by name.
#include <catch2/catch.hpp>
#include <filesystem>

#include "algorithm/dataset/open_dataset.h"
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
  for (const auto& [from, to] : {std::pair("1_0006", "6"),
                                 {"1_0007", "7"},
                                 {"1_0008", "8"},
                                 {"0_0000", "0"},
                                 {"0_0001", "1"},
                                 {"0_0002", "2"},
                                 {"0_0003", "3"},
                                 {"0_0004", "4"},
                                 {"0_0005", "5"},
                                 {"0_0009", "9"}}) {
    rename_view(scratch.path(""), from, to);
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

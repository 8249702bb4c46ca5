#include "testbench/streaminggs/fitting/test_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"

namespace sgs {
namespace {

constexpr const char* kPhotograph = "photograph";

}  // namespace

void TestPictures::add_to(CommandLine& line) {
  line.file("--pictures", folder,
            "folder for view_N_photograph.png and, of each look at the test views, "
            "view_N_step_STEPS.png");
  line.numbers("--picture-views", views, "numbers of test views for --pictures, as in 0,7");
  line.needs("--picture-views", "--pictures");
}

void TestPictures::add_to(OutputPlan& plan) const {
  if (folder.empty()) return;
  for (const int view : views) plan.add_output(file(view, kPhotograph));
}

void TestPictures::write_photographs(const Photographs& test, const glm::vec3& background) const {
  if (folder.empty()) return;
  for (const int view : views) {
    if (view < 0 || static_cast<std::size_t>(view) >= test.size()) {
      throw InputError(fmt::format("--picture-views: got {}, expected 0 .. {}, the test views",
                                   view, test.size() - 1));
    }
  }
  for (const int view : views) {
    write_image(file(view, kPhotograph), test.before(static_cast<std::size_t>(view), background));
  }
}

PictureSeen TestPictures::behind(int steps) const {
  if (folder.empty()) return {};
  return [this, steps](std::size_t at, const Image& picture) {
    const int view = static_cast<int>(at);
    if (std::find(views.begin(), views.end(), view) == views.end()) return;
    write_image(file(view, fmt::format("step_{:06}", steps)), picture);
  };
}

std::string TestPictures::file(int view, const std::string& what) const {
  return (std::filesystem::path(folder) / fmt::format("view_{}_{}.png", view, what)).string();
}

}  // namespace sgs

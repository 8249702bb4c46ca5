#include "tests/algorithm/dataset/damaged_datasets.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "algorithm/dataset/dataset.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {

Damage replace(const std::string& name, const std::string& from, const std::string& to) {
  return [=](const std::string& folder) {
    std::string text = bytes_of(folder + "/" + name);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    write_file(folder, name, text.replace(at, from.size(), to));
  };
}

Damage replace_all(const std::string& name, const std::string& from, const std::string& to) {
  return [=](const std::string& folder) {
    std::string text = bytes_of(folder + "/" + name);
    REQUIRE(text.find(from) != std::string::npos);
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
    write_file(folder, name, text);
  };
}

Damage move_to(const std::string& from, const std::string& to) {
  return [=](const std::string& folder) {
    const std::filesystem::path path = folder + "/" + to;
    std::filesystem::create_directories(path.parent_path());
    std::filesystem::rename(folder + "/" + from, path);
  };
}

Damage with(const std::string& name, const std::string& bytes) {
  return [=](const std::string& folder) { write_file(folder, name, bytes); };
}

Damage without(const std::string& name) {
  return [=](const std::string& folder) {
    REQUIRE(std::filesystem::remove_all(folder + "/" + name) > 0);
  };
}

Damage resize(const std::string& name, int width, int height) {
  return with(name, rgba_png(RgbaImage(width, height)));
}

void check_refused(const std::vector<DamagedDataset>& datasets) {
  for (const DamagedDataset& dataset : datasets) {
    const ScratchFolder scratch;
    const std::string folder = scratch.path("set");
    dataset.write(folder, made_scene());
    dataset.damage(folder);
    const std::string message = input_error_of([&] { open_dataset(folder); });
    for (const std::string& word : dataset.words) {
      CHECK_THAT(message, Catch::Matchers::Contains(word));
    }
  }
}

}  // namespace sgs::test

// A folder for the files of one test, and what bad input says.
#pragma once

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "algorithm/files/input_error.h"

namespace sgs::test {

// Made empty, removed with everything in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "sgs-test-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) FAIL("cannot make " << pattern);
    folder_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Writes `bytes` to the file `name` and gives its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

 private:
  std::filesystem::path folder_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::string bytes(file ? static_cast<std::size_t>(file.tellg()) : 0, '\0');
  file.seekg(0).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

// The message of the InputError that `action` throws, which must be one line; fails without one.
template <typename Action>
std::string input_error_of(const Action& action) {
  std::string message;
  try {
    action();
  } catch (const InputError& error) {
    message = error.what();
  }
  INFO(message);
  REQUIRE_FALSE(message.empty());
  REQUIRE(message.find('\n') == std::string::npos);
  return message;
}

}  // namespace sgs::test

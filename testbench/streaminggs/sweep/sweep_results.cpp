// Opening, reading and appending.
#include "testbench/streaminggs/sweep/sweep_results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// The beginning of every line. A torn last line that begins otherwise is a user's, and not touched.
constexpr std::string_view kBegin = R"({"key":")";

// A sweep that was killed has it until its children have ended, too.
bool lock(int file) {
  constexpr int kTries = 20;
  for (int i = 0; i < kTries; ++i) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

// True if the path still names the opened file.
bool is_at(int file, const std::string& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

bool may_be_torn(const std::string& line) {
  const std::size_t common = std::min(line.size(), kBegin.size());
  return line.compare(0, common, kBegin, 0, common) == 0;
}

}  // namespace

SweepResults::SweepResults(std::string path) : path_(std::move(path)) {
  open();
  try {
    read();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

SweepResults::~SweepResults() {
  if (size_ == 0) ::unlink(path_.c_str());
  ::close(file_);
}

void SweepResults::open() {
  open_and_lock();
  // A sweep that ended while this one waited for it has removed the file if it was empty.
  while (!is_at(file_, path_)) {
    ::close(file_);
    open_and_lock();
  }
}

void SweepResults::open_and_lock() {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
  if (file_ < 0) {
    throw InputError(fmt::format("--out: {}: cannot be opened ({})", path_, std::strerror(errno)));
  }
  struct stat facts {};
  const char* wrong = nullptr;
  if (::fstat(file_, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    wrong = "not a regular file, expected one, or none yet";
  } else if (!lock(file_)) {
    wrong = "another sweep is writing to it, expected that one to end, or a file of its own";
  }
  if (wrong == nullptr) return;
  ::close(file_);
  throw InputError(fmt::format("--out: {}: {}", path_, wrong));
}

void SweepResults::read() {
  const InputFile file(path_);
  const std::string text = file.text_from(0, file.size_bytes());
  std::uint64_t begin = 0;
  int number = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    remember(text.substr(begin, end - begin), begin, fmt::format("{}:{}", path_, ++number));
  }
  size_ = begin;
  if (begin == text.size()) return;
  if (!may_be_torn(text.substr(begin))) {
    throw InputError(fmt::format("--out: {}:{}: got no result of a sweep, expected only such",
                                 path_, number + 1));
  }
  if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) {
    throw InputError(
        fmt::format("--out: {}: cannot be written to ({})", path_, std::strerror(errno)));
  }
}

void SweepResults::remember(const std::string& line, std::uint64_t begin,
                            const std::string& place) {
  const Json result = Json::parse(line, nullptr, false);
  const auto text_at = [&](const char* key) {
    const bool there = result.is_object() && result.contains(key) && result[key].is_string();
    return there ? result[key].get<std::string>() : std::string();
  };
  const std::string key = text_at("key"), status = text_at("status");
  if (key.empty() || status.empty()) {
    throw InputError(fmt::format("--out: {}: got no result of a sweep, expected only such", place));
  }
  const auto attempts = result.find("attempts");
  const bool counted = attempts != result.end() && attempts->is_number_integer();
  places_[key] = {begin, line.size(), {status, counted ? attempts->get<int>() : 0}};
}

const SweepResults::Facts* SweepResults::find(const std::string& key) const {
  const auto found = places_.find(key);
  return found == places_.end() ? nullptr : &found->second.facts;
}

std::string SweepResults::line(const std::string& key) const {
  const Place& place = places_.at(key);
  return InputFile(path_).text_from(place.begin, place.bytes);
}

void SweepResults::add(const std::string& line) {
  const std::string text = line + "\n";
  const ssize_t written = ::write(file_, text.data(), text.size());
  if (written != static_cast<ssize_t>(text.size())) {
    const int error = errno;
    if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) { /* dropped by the next sweep */
    }
    throw std::runtime_error(
        fmt::format("{}: cannot be written completely{}", path_,
                    written < 0 ? fmt::format(" ({})", std::strerror(error)) : std::string()));
  }
  remember(line, size_, path_);
  size_ += text.size();
}

}  // namespace sgs

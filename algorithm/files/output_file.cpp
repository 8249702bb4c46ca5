// Places, temporary names and renaming; the checks of a plan.
#include "algorithm/files/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& got, const char* expected) {
  throw InputError(fmt::format("{}: {}, expected {}", path, got, expected));
}

// The folder of `path`, or the nearest one above it that exists.
fs::path nearest_folder(const fs::path& path) {
  fs::path folder = fs::absolute(path).parent_path();
  std::error_code ignored;
  while (!fs::exists(folder, ignored) && folder != folder.parent_path()) {
    folder = folder.parent_path();
  }
  return folder;
}

// A name beside `path` that no other writer has, neither here nor in another process.
std::string temporary_name(const fs::path& path, unsigned number) {
  constexpr std::size_t kMostNameBytes = 200;  // a name may have 255
  const std::string name = path.filename().string().substr(0, kMostNameBytes);
  return (path.parent_path() / fmt::format("{}.{}-{}.part", name, ::getpid(), number)).string();
}

// Refuses what stands at `path` already and is no file to replace.
void check_place(const std::string& path) {
  constexpr const char* kExpected = "a file to write";
  if (path.empty() || !fs::path(path).has_filename()) {
    refuse(fmt::format("\"{}\"", path), "not a file name", kExpected);
  }
  if (fs::path(path).filename().string().size() > NAME_MAX) {
    refuse(path, std::strerror(ENAMETOOLONG), kExpected);
  }
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) refuse(path, "a folder", kExpected);
    if (!S_ISREG(status.st_mode)) refuse(path, "a device or a pipe", kExpected);
    if (::access(path.c_str(), W_OK) != 0) refuse(path, std::strerror(errno), kExpected);
  } else if (errno != ENOENT) {
    refuse(path, std::strerror(errno), kExpected);
  }
}

constexpr unsigned kMostTries = 1000;  // to make folders that others take away

std::array<std::atomic<const char*>, 256> parts;
pid_t owner = 0;

// Nothing but what a handler may call.
extern "C" void remove_parts(int signal) {
  if (::getpid() == owner) {
    for (const auto& part : parts) {
      if (const char* path = part.load()) ::unlink(path);
    }
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// The first place that holds `from` holds `to`.
void exchange(const char* from, const char* to) {
  for (auto& part : parts) {
    const char* expected = from;
    if (part.compare_exchange_strong(expected, to)) return;
  }
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), made_folders_{{}, ::getpid()} {
  check_place(path_);
  int descriptor = -1;
  for (unsigned number = 0; descriptor < 0; ++number) {
    make_folders();
    temporary_path_ = temporary_name(path_, number);
    constexpr ::mode_t kMode = 0666;  // less the user's mask
    descriptor = ::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    // Another process takes a folder that it made and left empty away again.
    const bool again = errno == EEXIST || (errno == ENOENT && number < kMostTries);
    if (descriptor < 0 && !again) {
      refuse(path_, fmt::format("cannot be made ({})", std::strerror(errno)), "a writable place");
    }
  }
  remember_part(temporary_path_.c_str());
  file_ = ::fdopen(descriptor, "wb");
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!committed_ && ::getpid() == made_folders_.owner) ::unlink(temporary_path_.c_str());
  forget_part(temporary_path_.c_str());
}

OutputFile::MadeFolders::~MadeFolders() {
  if (::getpid() != owner) return;
  for (auto path = paths.rbegin(); path != paths.rend(); ++path) ::rmdir(path->c_str());
}

void OutputFile::make_folders() {
  const fs::path there = nearest_folder(path_);
  const fs::path folder = fs::absolute(path_).parent_path();
  fs::path made = there;
  for (const fs::path& name : folder.lexically_relative(there)) {
    if (name == ".") continue;
    made /= name;
    // Another process may have been faster, or have taken the one above away.
    if (::mkdir(made.c_str(), 0777) == 0) {
      made_folders_.paths.push_back(made.string());
    } else if (errno == ENOENT) {
      return;
    } else if (errno != EEXIST) {
      refuse(path_, fmt::format("{}: {}", made.string(), std::strerror(errno)),
             "a folder that can be made");
    }
  }
}

void OutputFile::write(const void* data, std::size_t size_bytes) {
  if (size_bytes == 0 || error_ != 0) return;
  if (std::fwrite(data, 1, size_bytes, file_) != size_bytes) error_ = errno;
}

void OutputFile::finish() {
  if (error_ == 0 && std::fflush(file_) != 0) error_ = errno;
  if (error_ != 0) {
    throw std::runtime_error(
        fmt::format("{}: cannot be written completely ({})", path_, std::strerror(error_)));
  }
}

void OutputFile::commit() {
  finish();
  // Some file systems say only now that the disk is full.
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!closed || std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    throw std::runtime_error(
        fmt::format("{}: cannot be written completely ({})", path_, std::strerror(errno)));
  }
  committed_ = true;
}

void write_whole_file(const std::string& path, const void* data, std::size_t size_bytes) {
  OutputFile output(path);
  output.write(data, size_bytes);
  output.commit();
}

void OutputPlan::check() const {
  namespace fs = std::filesystem;
  std::map<fs::path, std::string> places;
  for (const std::string& output : outputs_) {
    { const OutputFile can_be_made(output); }
    const fs::path place = fs::weakly_canonical(fs::absolute(output));
    for (const std::string& input : inputs_) {
      std::error_code ignored;  // one of them is not there
      if (fs::equivalent(place, input, ignored)) {
        throw InputError(
            fmt::format("{}: is the same file as the input {}, expected another", output, input));
      }
    }
    const auto [same, first] = places.emplace(place, output);
    if (!first) {
      throw InputError(fmt::format("{}: is the same file as the output {}, expected another",
                                   output, same->second));
    }
  }
  for (const auto& [place, output] : places) {
    for (fs::path folder = place.parent_path(); folder != folder.root_path();
         folder = folder.parent_path()) {
      const auto file = places.find(folder);
      if (file == places.end()) continue;
      throw InputError(fmt::format(
          "{}: lies below {}, which is an output itself, expected a folder", output, file->second));
    }
  }
}

void remember_part(const char* path) { exchange(nullptr, path); }
void forget_part(const char* path) { exchange(path, nullptr); }

void remove_parts_on_signals() {
  owner = ::getpid();
  for (const int signal : {SIGINT, SIGTERM}) {
    if (std::signal(signal, remove_parts) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace sgs

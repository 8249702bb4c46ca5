// Temporary names and renaming for output_file.h.
#include "algorithm/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "algorithm/input_error.h"

namespace sgs {
namespace fs = std::filesystem;

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  // The number keeps two writers of one process apart, the process id two runs.
  static std::atomic<unsigned> count{0};
  temporary_path_ = fmt::format("{}.{}-{}.part", path_, ::getpid(), count++);
  std::error_code ignored;
  if (path_.empty() || fs::is_directory(path_, ignored)) {
    throw InputError(fmt::format("\"{}\": not a file name, expected a file to write", path_));
  }
  const fs::path folder = fs::path(path_).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    throw InputError(fmt::format("{}: folder {} is not there, expected an existing folder", path_,
                                 folder.string()));
  }
}

OutputFile::~OutputFile() {
  if (!committed_) std::remove(temporary_path_.c_str());
}

void OutputFile::commit() {
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    throw std::runtime_error(fmt::format("{}: cannot rename {} to it: {}", path_, temporary_path_,
                                         std::strerror(errno)));
  }
  committed_ = true;
}

void write_whole_file(const std::string& path, const void* data, std::size_t size_bytes) {
  OutputFile output(path);
  std::FILE* file = std::fopen(output.temporary_path().c_str(), "wb");
  if (file == nullptr) {
    throw InputError(fmt::format("{}: cannot be created ({}), expected a writable place", path,
                                 std::strerror(errno)));
  }
  const bool written = std::fwrite(data, 1, size_bytes, file) == size_bytes;
  // fclose flushes: a full disk may show only here.
  if (std::fclose(file) != 0 || !written) {
    throw std::runtime_error(
        fmt::format("{}: cannot write {} bytes: {}", path, size_bytes, std::strerror(errno)));
  }
  output.commit();
}

}  // namespace sgs

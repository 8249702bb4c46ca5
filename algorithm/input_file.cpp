// POSIX calls behind input_file.h.
#include "algorithm/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "algorithm/input_error.h"

namespace sgs {

InputFile::InputFile(std::string path) : path_(std::move(path)) {
  // Opening a pipe for reading would wait for its writer: O_NONBLOCK lets it be refused instead.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    throw InputError(fmt::format("{}: cannot be opened ({}), expected a readable file", path_,
                                 std::strerror(errno)));
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw InputError(fmt::format("{}: not a regular file, expected one", path_));
  }
  size_bytes_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read_at(std::uint64_t offset_bytes, void* out, std::size_t size) const {
  auto* to = static_cast<char*>(out);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        ::pread(descriptor_, to + done, size - done, static_cast<off_t>(offset_bytes + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      throw InputError(fmt::format("{}: byte {}: {}, expected {} more bytes", path_,
                                   offset_bytes + done,
                                   got == 0 ? "the file ends" : std::strerror(errno), size - done));
    }
    done += static_cast<std::size_t>(got);
  }
}

std::string InputFile::text_from(std::uint64_t offset_bytes, std::uint64_t most_bytes) const {
  if (offset_bytes >= size_bytes_) return {};
  std::string text(std::min(most_bytes, size_bytes_ - offset_bytes), '\0');
  read_at(offset_bytes, text.data(), text.size());
  return text;
}

}  // namespace sgs

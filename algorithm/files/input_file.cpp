// POSIX calls, and the line ends in the blocks that are read.
#include "algorithm/files/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "algorithm/files/input_error.h"

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

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool LineReader::next(std::string_view& line) {
  constexpr std::size_t kBlockBytes = 1 << 18;
  static_assert(kBlockBytes > kMostLineBytes, "a block holds at least a line");
  std::size_t end = block_.find('\n', position_);
  if (end == std::string::npos && offset_bytes_ < file_.size_bytes()) {
    const std::string more = file_.text_from(offset_bytes_, kBlockBytes);
    offset_bytes_ += more.size();
    block_.erase(0, position_);
    block_ += more;
    position_ = 0;
    end = block_.find('\n');
  }
  if (end == std::string::npos) end = block_.size();
  ++line_number_;
  if (position_ == block_.size()) return false;
  if (end - position_ > kMostLineBytes) {
    throw InputError(fmt::format("{}: line {}: longer than {} bytes, expected a shorter one",
                                 file_.path(), line_number_, kMostLineBytes));
  }
  line = std::string_view(block_).substr(position_, end - position_);
  position_ = std::min(end + 1, block_.size());
  return true;
}

}  // namespace sgs

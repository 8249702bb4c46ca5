// A file to read from at any offset, with errors that name it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace sgs {

// Several threads may read at once. The size is taken at opening: whoever reads a header checks it
// against size_bytes() before allocating anything.
class InputFile {
 public:
  // Throws InputError when `path` is missing, not readable or not a regular file.
  explicit InputFile(std::string path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size_bytes() const { return size_bytes_; }

  // Reads exactly [offset, offset + size) into `out`. Throws InputError when the file ends before.
  void read_at(std::uint64_t offset_bytes, void* out, std::size_t size) const;

  // The bytes from `offset` to the end or to `most_bytes`, whichever comes first.
  std::string text_from(std::uint64_t offset_bytes, std::uint64_t most_bytes) const;

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace sgs

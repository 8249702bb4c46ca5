// Files to read from, at any offset or line by line, with errors that name the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

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

// The extension of a path in small letters, with its dot: ".ply".
std::string extension_of(const std::string& path);

// A text file line by line.
constexpr std::size_t kMostLineBytes = 4096;

class LineReader {
 public:
  // Throws InputError as InputFile does.
  explicit LineReader(const std::string& path) : file_(path) {}

  const std::string& path() const { return file_.path(); }
  // The number of the last line, from 1; at the end of the file, that of the line behind it.
  std::uint64_t line_number() const { return line_number_; }

  // The next line without its end, until the next call; false at the end of the file. Throws
  // InputError for a line longer than kMostLineBytes.
  bool next(std::string_view& line);

 private:
  const InputFile file_;
  std::uint64_t offset_bytes_ = 0;  // first byte after block_
  std::string block_;
  std::size_t position_ = 0;  // in block_
  std::uint64_t line_number_ = 0;
};

}  // namespace sgs

// A text file line by line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "algorithm/input_file.h"

namespace sgs {

constexpr std::size_t kMostLineBytes = 4096;

class LineReader {
 public:
  // Throws InputError as InputFile does.
  explicit LineReader(const std::string& path) : file_(path) {}

  const std::string& path() const { return file_.path(); }
  // Of the last line, from 1; at the end of the file, of the one that is not there.
  std::uint64_t line_number() const { return line_number_; }

  // The next line without its end, until the next call; false at the end of the file. Throws
  // InputError for a line longer than kMostLineBytes.
  bool next(std::string_view& line);

 private:
  const InputFile file_;
  std::uint64_t offset_bytes_ = 0;  // of the first byte after block_
  std::string block_;
  std::size_t position_ = 0;  // in block_
  std::uint64_t line_number_ = 0;
};

}  // namespace sgs

// An output file that appears under its name only once it is complete.
#pragma once

#include <cstddef>
#include <string>

namespace sgs {

// Write to temporary_path() by whatever means, then call commit(). A reader of `path` sees the old
// file or the whole new one, never a part; without commit() the temporary is removed.
class OutputFile {
 public:
  // Throws InputError when the folder of `path` does not exist or `path` is a folder itself.
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary_path() const { return temporary_path_; }

  // Renames the temporary to path(). Throws std::runtime_error when the system refuses.
  void commit();

 private:
  std::string path_;
  std::string temporary_path_;
  bool committed_ = false;
};

// Writes `size_bytes` bytes as the whole content of `path`. Throws InputError when the file cannot
// be created and std::runtime_error when it cannot be written (disk full).
void write_whole_file(const std::string& path, const void* data, std::size_t size_bytes);

}  // namespace sgs

// Output files that appear under their names only once they are complete, alone or as a set, and
// the check of all of a command's files before it begins.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace sgs {

// A reader of `path` sees the old file or the whole new one, never a part. Bytes go to a temporary
// beside it; without commit() that is removed again, with every folder that was made for it. A
// child process may write and call finish(): the process that made the file commits it.
class OutputFile {
 public:
  // Throws InputError unless a file can be made, or replaced, as `path`: a folder, device or pipe
  // stands there, or one that may not be written to, or no temporary can be made beside it.
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary_path() const { return temporary_path_; }

  // Errors are kept for finish().
  void write(const void* data, std::size_t size_bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  // Every byte is with the system. Throws std::runtime_error where one could not be written.
  void finish();

  // finish(), and what was written is the file `path`.
  void commit();

 private:
  // Removes folders again, as far as nothing is in them.
  struct MadeFolders {
    std::vector<std::string> paths;  // outermost first
    pid_t owner;
    ~MadeFolders();
  };
  void make_folders();

  std::string path_;
  std::string temporary_path_;
  MadeFolders made_folders_;
  std::FILE* file_ = nullptr;
  int error_ = 0;  // the first; as errno
  bool committed_ = false;
};

// Writes `size_bytes` bytes as the whole content of `path`. Throws as OutputFile does.
void write_whole_file(const std::string& path, const void* data, std::size_t size_bytes);

// Output files that belong together: all of them appear under their names or, when one cannot be
// written, none does.
class OutputSet {
 public:
  OutputSet() = default;
  // The last first: the first one may have made the folder that all are in.
  ~OutputSet() {
    while (!files_.empty()) files_.pop_back();
  }
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  // Throws as OutputFile does. The reference holds as long as the set.
  OutputFile& add(const std::string& path) { return files_.emplace_back(path); }

  void commit() {
    for (OutputFile& file : files_) file.finish();
    for (OutputFile& file : files_) file.commit();
  }

 private:
  std::deque<OutputFile> files_;
};

// The files that a command reads and writes, checked as a whole before it begins.
class OutputPlan {
 public:
  // Names that are no file, and empty ones, are for whoever reads them to judge.
  void add_input(const std::string& path) { inputs_.push_back(path); }
  void add_output(const std::string& path) { outputs_.push_back(path); }
  const std::vector<std::string>& inputs() const { return inputs_; }

  // Throws InputError when an output cannot be made (as OutputFile does), when it is one of the
  // inputs by whatever name or link, when two outputs are the same file, and when one is the folder
  // of another. Leaves nothing.
  void check() const;

 private:
  std::vector<std::string> inputs_;
  std::vector<std::string> outputs_;
};

// path: of a file; must stay where it is in memory until it is forgotten. From any thread. At most
// a few hundred at once are remembered.
void remember_part(const char* path);
void forget_part(const char* path);

// From now on SIGINT and SIGTERM, unless they are ignored, remove what is remembered and then end
// the process as ever. Its children leave that to it.
void remove_parts_on_signals();

}  // namespace sgs

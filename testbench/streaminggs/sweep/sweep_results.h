// The file of a sweep's results, a JSON object a line, which later sweeps go on with.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace sgs {

// One sweep at a time has such a file open. A line is written at once or not at all, and whoever is
// killed leaves at most the beginning of one, which the next sweep drops. Where a key stands in
// several lines the last one counts.
class SweepResults {
 public:
  // Opens the file, or makes it with the folders it is to be in. Throws InputError when it cannot,
  // when another sweep has it open, and when it holds what no sweep wrote; then it is as it was.
  explicit SweepResults(std::string path);
  // Removes a file that nothing was written to.
  ~SweepResults();
  SweepResults(const SweepResults&) = delete;
  SweepResults& operator=(const SweepResults&) = delete;

  struct Facts {
    std::string status;
    int attempts = 0;  // how often a failed point was attempted
  };
  // The facts of a key's result; null where there is none.
  const Facts* find(const std::string& key) const;

  // The line of a key that is there, as it was written.
  std::string line(const std::string& key) const;

  // Adds a line, which has the members `key` and `status`. Throws std::runtime_error when it cannot
  // be written; then the file is as it was.
  void add(const std::string& line);

 private:
  struct Place {
    std::uint64_t begin = 0, bytes = 0;
    Facts facts;
  };
  void open();
  void open_and_lock();
  void read();
  void remember(const std::string& line, std::uint64_t begin, const std::string& place);

  const std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::map<std::string, Place> places_;  // by key
};

}  // namespace sgs

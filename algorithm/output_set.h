// Output files that belong together.
#pragma once

#include <deque>
#include <string>

#include "algorithm/output_file.h"

namespace sgs {

// Either all of them appear under their names or, when one cannot be written, none does.
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

}  // namespace sgs

// A fitting that is to go on later: a file with all that the next step depends on.
#pragma once

#include <string>

namespace sgs {

struct Checkpoint {
  std::string work;      // one line that says of what and how; whoever resumes compares it
  std::string pace;      // values that may differ from here on, in words; may be empty
  std::string contents;  // digest of the files that `work` names; compared, too
  std::string log;       // the log so far
  double seconds = 0;    // duration up to here
  std::string state;     // Fitting::saved()
};

// Appears under `path` once it is complete. Throws InputError when `path` cannot be created,
// std::runtime_error when it cannot be written.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

// Throws InputError: not such a file, of another version, cut off or changed, or with lengths that
// it has not the bytes for.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace sgs

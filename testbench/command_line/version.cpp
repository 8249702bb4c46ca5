// Version and commit, as the build was told.
#include "testbench/command_line/version.h"

#include <fmt/format.h>

#include "commit.h"  // made by the build

namespace sgs {

std::string version() { return SGS_VERSION; }

std::string commit() { return SGS_COMMIT; }

std::string version_text() {
  return commit().empty() ? version() : fmt::format("{} ({})", version(), commit());
}

}  // namespace sgs

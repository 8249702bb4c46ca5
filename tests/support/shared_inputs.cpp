#include "tests/support/shared_inputs.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace sgs::test {
namespace fs = std::filesystem;

namespace {
[[noreturn]] void skip(const std::string& why) {
  std::printf("skipped: %s\n", why.c_str());
  std::fflush(stdout);
  std::_Exit(77);
}
}  // namespace

std::string shared_path(const std::string& relative) {
  const char* set = std::getenv("SGS_SHARED");
  const fs::path root = set ? fs::path(set) : fs::path(SGS_SOURCE_DIR) / ".." / "shared";
  const fs::path path = root / relative;
  if (!fs::exists(path)) skip(path.string() + " is not there");
  return path.string();
}

std::string shared_scene(const std::string& name) {
  const fs::path folder = fs::path(SGS_BINARY_DIR) / "scenes";
  const std::string script = shared_path("scenes/expand.sh");
  shared_path("scenes/" + name + ".ply.xz");
  // Tests run side by side: the lock lets one of them unpack while the others wait.
  fs::create_directories(folder);
  const std::string command =
      "flock '" + folder.string() + "/.lock' sh '" + script + "' '" + folder.string() + "' " + name;
  if (std::system(command.c_str()) != 0) skip("cannot unpack " + name + " (is xz installed?)");
  return (folder / (name + ".ply")).string();
}

}  // namespace sgs::test

// Real scenes for tests. They lie beside the project, not in it, and may be missing.
#pragma once

#include <string>

namespace sgs::test {

// Path of ../shared/RELATIVE (or $SGS_SHARED/RELATIVE). Where it is missing the process says so and
// exits 77, which ctest reports as skipped.
std::string shared_path(const std::string& relative);

// Path of the scene NAME unpacked as .ply under the build folder; skips as above.
std::string shared_scene(const std::string& name);

}  // namespace sgs::test

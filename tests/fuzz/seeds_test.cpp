// Every seed of the fuzzers goes through its reader, in every build: good_* are taken, so that
// fuzzing begins behind the first check, bad_* are refused.
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/fuzz/fuzzed_reader.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("fuzzed readers: good seeds are taken, bad ones refused") {
  for (const FuzzedReader& reader : fuzzed_readers()) {
    const ScratchFolder scratch;
    reader.prepare(scratch.path(""));
    int taken = 0;
    for (const auto& seed :
         fs::directory_iterator(SGS_SOURCE_DIR "/tests/fuzz/corpus/" + reader.name)) {
      const std::string name = seed.path().filename().string();
      INFO(reader.name << "/" << name);
      const bool good = takes(reader, scratch.path(""), bytes_of(seed.path().string()));
      taken += good;
      CHECK(name.rfind(good ? "good_" : "bad_", 0) == 0);
      CHECK(fs::file_size(seed.path()) <= 4096);
    }
    INFO(reader.name);
    CHECK(taken > 0);
  }
}

}  // namespace
}  // namespace sgs::test

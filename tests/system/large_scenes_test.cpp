// Every view of the large scenes, and what the small ones leave out.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/shared_scenes.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

void plain(const char* scene, const char* preset) { check_shared_scene(scene, preset, {kPlain}); }
void stalled_too(const char* scene, const char* preset) {
  check_shared_scene(scene, preset, {kPlain, kStalled});
}
TEST_CASE("shared scenes: truck, paper order, no stalls", "[nightly]") { plain("truck", "paper"); }
TEST_CASE("shared scenes: truck, exact order, no stalls", "[nightly]") { plain("truck", "exact"); }
TEST_CASE("shared scenes: playbot, paper order, no stalls", "[nightly]") {
  plain("playbot", "paper");
}
TEST_CASE("shared scenes: playbot, exact order, no stalls", "[nightly]") {
  plain("playbot", "exact");
}
TEST_CASE("shared scenes: platform, paper order", "[nightly]") { stalled_too("platform", "paper"); }
TEST_CASE("shared scenes: platform, exact order", "[nightly]") { stalled_too("platform", "exact"); }
TEST_CASE("shared scenes: yard, paper order", "[nightly]") { stalled_too("yard", "paper"); }
TEST_CASE("shared scenes: yard, exact order", "[nightly]") { stalled_too("yard", "exact"); }
TEST_CASE("shared scenes: garden, paper order", "[nightly]") { stalled_too("garden", "paper"); }
TEST_CASE("shared scenes: garden, exact order", "[nightly]") { stalled_too("garden", "exact"); }
TEST_CASE("shared scenes: park, paper order", "[nightly]") { stalled_too("park", "paper"); }
TEST_CASE("shared scenes: park, exact order", "[nightly]") { stalled_too("park", "exact"); }

// The encodings that the presets above do not have, all views.
void check_encodings(const char* scene) {
  for (const char* order : {"paper_no_vq", "exact"}) {
    std::vector<Variant> variants;
    for (const char* encoding : {"half", "vq", "vq_packed"}) {
      variants.push_back(
          settings({std::string("storage.encoding=") + encoding, "sram.codebook_bytes=256000"}));
    }
    check_shared_scene(scene, order, variants);
  }
}
TEST_CASE("shared scenes: truck, every encoding", "[nightly]") { check_encodings("truck"); }
TEST_CASE("shared scenes: playbot, every encoding", "[nightly]") { check_encodings("playbot"); }
TEST_CASE("shared scenes: platform, every encoding", "[nightly]") { check_encodings("platform"); }
TEST_CASE("shared scenes: yard, every encoding", "[nightly]") { check_encodings("yard"); }
TEST_CASE("shared scenes: garden, every encoding", "[nightly]") { check_encodings("garden"); }
TEST_CASE("shared scenes: park, every encoding", "[nightly]") { check_encodings("park"); }

}  // namespace
}  // namespace sgs::test

// What a misspelt name is taken for.
#include <catch2/catch.hpp>

#include "algorithm/files/input_error.h"

namespace sgs::test {
namespace {

const std::vector<std::string> kNames = {"exact", "exact_half", "paper", "gscore", "hfus"};

TEST_CASE("nearest name: insertions, deletions, exchanges and swaps, a third of the word at most") {
  for (const auto& [word, name] :
       std::vector<std::pair<std::string, std::string>>{{"exact", "exact"},
                                                        {"exat", "exact"},
                                                        {"exxact", "exact"},
                                                        {"exqct", "exact"},
                                                        {"exatc", "exact"},
                                                        {"exact_hlaf", "exact_half"},
                                                        {"hfu", "hfus"},
                                                        {"gcsoer", "gscore"}}) {
    INFO(word);
    const auto nearest = nearest_name(word, kNames);
    REQUIRE(nearest);
    CHECK(kNames[*nearest] == name);
    CHECK(did_you_mean(word, kNames) == "; did you mean " + name + "?");
  }
  for (const std::string& word : {std::string(), std::string("x"), std::string("hf__"),
                                  std::string("pencil"), std::string(100000, 'p')}) {
    CHECK_FALSE(nearest_name(word, kNames));
    CHECK(did_you_mean(word, kNames).empty());
  }
  CHECK_FALSE(nearest_name("exact", {}));
}

TEST_CASE("nearest name: of several as near the first") {
  CHECK(nearest_name("lanex", {"lanes", "laned", "lane"}) == 0U);
  CHECK(nearest_name("lane", {"lanes", "laned", "lane"}) == 2U);
}

TEST_CASE("nearest name: keys by their last part, then by their path") {
  const std::vector<std::string> paths = {"hfus", "sram.input_bytes", "vsu.input_bytes"};
  CHECK(nearest_key("sram.input_byte", paths) == 1U);
  CHECK(nearest_key("vsu.input_byts", paths) == 2U);
  CHECK(nearest_key("input_bytes", paths) == 2U);
  CHECK(nearest_key("machine.hfu", paths) == 0U);
  CHECK(nearest_key("vsuu.input_bytes", paths) == 2U);
  CHECK_FALSE(nearest_key("colour", paths));
  CHECK_FALSE(nearest_key("sram.output_lines", paths));
}

}  // namespace
}  // namespace sgs::test

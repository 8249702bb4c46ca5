// provenance.h: what tells that two runs were fed the same bytes.
#include "testbench/streaminggs/report/provenance.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

TEST_CASE("hash: as xxhsum has it, of bytes, of a text, of a file") {
  struct Row {
    std::string text;
    std::uint64_t hash;
  };
  const ScratchFolder scratch;
  for (const Row& row : std::vector<Row>{{"", 0xef46db3751d8e999U}, {"abc", 0x44bc2cf5ad770999U}}) {
    const auto* const bytes = reinterpret_cast<const std::byte*>(row.text.data());
    CHECK(xxh64({bytes, bytes + row.text.size()}) == row.hash);
    CHECK(xxh64_of_text(row.text) == row.hash);
    CHECK(xxh64_of_file(scratch.write("text", row.text)) == row.hash);
  }
}

TEST_CASE("hash: the signs of numbers count, and how many zeros there are") {
  const std::vector<std::byte> zeros(64);
  std::vector<std::byte> turned = zeros;
  for (const std::size_t at : {7U, 15U}) turned[at] = std::byte{0x80};
  CHECK(xxh64(turned) != xxh64(zeros));
  CHECK(xxh64(std::vector<std::byte>(63)) != xxh64(zeros));
}

TEST_CASE("command line: words as a shell takes them") {
  struct Row {
    const char *word, *quoted;
  };
  for (const Row& row : std::vector<Row>{{"hfus=2", "hfus=2"},
                                         {"builtin:object?n=5", "'builtin:object?n=5'"},
                                         {"my scene.ply", "'my scene.ply'"},
                                         {"it's", "'it'\\''s'"},
                                         {"", "''"}}) {
    CHECK(quoted_for_shell(row.word) == row.quoted);
  }
}

}  // namespace
}  // namespace sgs::test

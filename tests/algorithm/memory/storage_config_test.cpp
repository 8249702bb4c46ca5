// What a choice of storage says before the scene is known.
#include "algorithm/memory/storage_config.h"

#include <catch2/catch.hpp>

namespace sgs {
namespace {

using Encoding = SecondHalfEncoding;

TEST_CASE(
    "storage: the widest format has as many entries as codebooks may get, where there are any") {
  struct Case {
    Encoding encoding;
    int sh_degree;
    std::array<std::uint32_t, kCodebookCount> entries;
    std::uint32_t bytes, codebook_bytes;
  };
  for (const Case& c : {Case{Encoding::kRaw, 3, {}, 220, 0}, Case{Encoding::kHalf, 3, {}, 110, 0},
                        Case{Encoding::kVq, 3, {4096, 4096, 4096, 512}, 17, 256000},
                        Case{Encoding::kVq, 0, {4096, 4096, 4096, 0}, 13, 160 * 1024},
                        Case{Encoding::kVqPacked, 3, {4096, 4096, 4096, 512}, 8, 256000}}) {
    StorageConfig config;
    config.encoding = c.encoding;
    INFO(static_cast<int>(c.encoding) << ", degree " << c.sh_degree);
    const SecondHalfFormat format = config.widest_format(c.sh_degree);
    CHECK(format.encoding == c.encoding);
    CHECK(format.sh_degree == c.sh_degree);
    CHECK(format.entries == c.entries);
    CHECK(format.bytes() == c.bytes);
    CHECK(format.codebook_bytes() == c.codebook_bytes);
  }
}

}  // namespace
}  // namespace sgs

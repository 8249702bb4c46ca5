// The stored bytes: zero until written, across block borders, nothing beyond the capacity.
#include "modules/dram/byte_store.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

namespace sgs {
namespace {

TEST_CASE("byte store: bytes cross block borders and are 0 until written") {
  ByteStore store(3 << 20);
  const std::vector<std::uint8_t> data(1000, 7);
  const std::uint64_t border = (1 << 20) - 500;
  store.write(border, data.data(), data.size());
  std::vector<std::uint8_t> read(1002, 9);
  store.read(border - 1, read.data(), read.size());
  CHECK(read.front() == 0);
  CHECK(read.back() == 0);
  CHECK(std::vector<std::uint8_t>(read.begin() + 1, read.end() - 1) == data);
  store.read((2 << 20) + 5, read.data(), 3);  // a block never written
  CHECK(read[0] == 0);
}

TEST_CASE("byte store: the capacity is the border, also where it is no whole block") {
  ByteStore store((1 << 20) + 10);
  std::uint8_t byte = 1;
  store.write((1 << 20) + 9, &byte, 1);
  CHECK_THROWS_AS(store.write((1 << 20) + 10, &byte, 1), std::out_of_range);
  CHECK_THROWS_AS(store.read((1 << 20) + 9, &byte, 2), std::out_of_range);
  CHECK_THROWS_AS(store.read(~std::uint64_t{0}, &byte, 2), std::out_of_range);
}

}  // namespace
}  // namespace sgs

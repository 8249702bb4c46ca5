// On-chip memory as a configuration asks for it, with the arithmetic behind each use.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sgs {

// One use of one of the on-chip memories, as often as it is there.
struct SramUse {
  std::string name;
  std::string memory;       // which one: "input", "codebook", "shared"
  std::uint64_t bytes = 0;  // of one
  std::string arithmetic;   // how they come about: "8 slots x 256 B"
  std::uint64_t count = 1;

  std::uint64_t total_bytes() const { return count * bytes; }
  // "4 x 8 slots x 256 B": of all.
  std::string product() const;
};

using SramUses = std::vector<SramUse>;

using SramFactors = std::vector<std::pair<std::uint64_t, const char*>>;  // (value, what it counts)

// The product of the factors.
SramUse sram_use(const char* name, const char* memory, const SramFactors& factors);

// `count` more of a use. Uses that differ in nothing but their number become one.
void add(SramUses& to, const SramUse& use, std::uint64_t count = 1);
void add(SramUses& to, const SramUses& uses, std::uint64_t count = 1);

// Bytes of all uses of one memory.
std::uint64_t sram_bytes(const SramUses& uses, const std::string& memory);

// "a 12 (3 x 4 B) + b 8 (8 B)": the uses of one memory.
std::string sram_sum(const SramUses& uses, const std::string& memory);

}  // namespace sgs

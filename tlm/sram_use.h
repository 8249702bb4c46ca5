// On-chip memory as a configuration asks for it, with the arithmetic behind each use.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sgs {

enum class SramPorts : std::uint8_t {
  kOne,          // one access a cycle, read or write
  kReadAndWrite  // a read and a write a cycle
};

// Shape of one memory of a use; area, energy of an access and accesses a cycle follow from it.
struct SramShape {
  std::uint32_t width_bits;                    // bits of one access
  SramPorts ports = SramPorts::kReadAndWrite;  // ports of each bank
  std::uint32_t banks = 1;                     // the bytes are spread over them
};
constexpr bool operator==(const SramShape& a, const SramShape& b) {
  return a.width_bits == b.width_bits && a.ports == b.ports && a.banks == b.banks;
}

// Most accesses in one cycle, over all banks.
struct SramPeak {
  std::uint32_t reads, writes;
};
constexpr bool operator==(const SramPeak& a, const SramPeak& b) {
  return a.reads == b.reads && a.writes == b.writes;
}
// Accesses a cycle, at most, of most uses: as many as a bank of two ports gives.
constexpr SramPeak kOneOfEach{1, 1};

// Banks of at most so many rows are flip-flops, not SRAM: shorter than the row of words that a
// macro's periphery is worth. It is a rule of shape, so that what a configuration may hold does not
// hang on prices; the technology table's middle values put the boundary there too.
constexpr std::uint32_t register_rows(SramPorts ports) { return ports == SramPorts::kOne ? 4 : 9; }

// One use of one of the on-chip memories, as often as it is there.
struct SramUse {
  std::string name;
  std::string memory;       // which one: "input", "codebook", "shared"
  std::uint64_t bytes = 0;  // bytes of one memory
  std::string arithmetic;   // how they come about: "8 slots x 256 B"
  std::uint64_t count = 1;
  SramShape shape{32};
  SramPeak peak = kOneOfEach;  // accesses of one memory in a cycle, at most

  std::uint64_t total_bytes() const { return count * bytes; }
  bool in_registers() const {
    return 8 * bytes <= std::uint64_t{register_rows(shape.ports)} * shape.banks * shape.width_bits;
  }
  // "4 x 8 slots x 256 B": of all.
  std::string product() const;
};

using SramUses = std::vector<SramUse>;

using SramFactors = std::vector<std::pair<std::uint64_t, const char*>>;  // (value, what it counts)

// The product of the factors.
SramUse sram_use(const char* name, const char* memory, const SramFactors& factors,
                 const SramShape& shape, const SramPeak& peak);

// Accesses of `width_bits` that move so many bytes, the last one not full.
constexpr std::uint64_t sram_words(std::uint64_t bytes, const SramShape& shape) {
  return (8 * bytes + shape.width_bits - 1) / shape.width_bits;
}

// `count` more of a use. Uses that differ in nothing but their number become one.
void add(SramUses& to, const SramUse& use, std::uint64_t count = 1);
void add(SramUses& to, const SramUses& uses, std::uint64_t count = 1);

// Bytes of SRAM of all uses of one memory; registers take none of it.
std::uint64_t sram_bytes(const SramUses& uses, const std::string& memory);

// "a 12 (3 x 4 B) + b 8 (8 B)": the uses of one memory that sram_bytes() adds up.
std::string sram_sum(const SramUses& uses, const std::string& memory);

// One line of text for a memory that is too small: its four largest uses, and how many more.
std::string largest_uses(const SramUses& uses, const std::string& memory);

}  // namespace sgs

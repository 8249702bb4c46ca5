// Place of an address: channel, rank, bank, row and burst, by a string of fields.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"

namespace sgs {

// A burst's place. `burst` counts bursts within the row.
struct DramAddress {
  std::uint32_t channel = 0;
  std::uint32_t rank = 0;
  std::uint32_t bank = 0;
  std::uint32_t row = 0;
  std::uint32_t burst = 0;
};

class AddressMapping {
 public:
  // InputError when config.mapping is not made of the fields row, rank, bank, group, column and
  // channel, or does not take exactly their sizes. A bank's number is that in its group, then the
  // group's; a channel's is of pseudo-channels where the memspec has some.
  AddressMapping(const DramConfig& config, const Memspec& memspec);

  DramAddress decode(std::uint64_t address) const {
    std::uint32_t field[kFields] = {};
    std::uint64_t rest = address >> burst_bits_;
    for (const Piece& piece : pieces_) {
      field[piece.field] |= (static_cast<std::uint32_t>(rest) & piece.mask) << piece.to;
      rest >>= piece.bits;
    }
    std::uint32_t bank = field[kBank] << group_bits_ | field[kGroup];
    if (xor_banks_) bank ^= field[kRow] & bank_mask_;
    return {field[kChannel], field[kRank], bank, field[kRow], field[kColumn]};
  }

  // The inverse: the address of a burst's first byte.
  std::uint64_t encode(const DramAddress& place) const;

  std::uint64_t capacity_bytes() const { return capacity_bytes_; }
  std::uint32_t burst_bytes() const { return 1u << burst_bits_; }

  // Contiguous bytes, aligned to their number, that lie in one row of one bank of one channel.
  std::uint32_t run_bytes() const { return run_bytes_; }

 private:
  enum Field { kRow, kRank, kBank, kGroup, kColumn, kChannel, kFields };
  struct Piece {  // from the least significant
    Field field;
    std::uint32_t bits;
    std::uint32_t mask;
    std::uint32_t to;  // bit of the field that it starts at
  };

  std::vector<Piece> pieces_;
  std::uint32_t burst_bits_ = 0;
  std::uint32_t group_bits_ = 0;
  std::uint32_t bank_mask_ = 0;
  bool xor_banks_ = false;
  std::uint64_t capacity_bytes_ = 0;
  std::uint32_t run_bytes_ = 0;
};

}  // namespace sgs

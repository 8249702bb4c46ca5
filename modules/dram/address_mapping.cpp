// Place of an address, by a string of fields.
#include "modules/dram/address_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {
std::uint32_t log2_of(std::uint64_t n) {
  std::uint32_t bits = 0;
  while ((std::uint64_t{1} << bits) < n) ++bits;
  return bits;
}
}  // namespace

AddressMapping::AddressMapping(const DramConfig& config, const Memspec& memspec) {
  constexpr std::array<const char*, kFields> kNames = {"row",   "rank",   "bank",
                                                       "group", "column", "channel"};
  group_bits_ = log2_of(memspec.organisation.bank_groups);
  const std::array<std::uint32_t, kFields> sizes = {
      log2_of(memspec.organisation.rows),
      log2_of(config.ranks),
      log2_of(memspec.organisation.banks) - group_bits_,
      group_bits_,
      log2_of(memspec.bursts_per_row()),
      log2_of(config.buses(memspec))};
  const auto refuse = [&](const std::string& expected) {
    throw InputError(fmt::format("dram.mapping: got '{}', expected {}", config.mapping, expected));
  };

  struct Token {
    Field field;
    std::uint32_t bits;
    bool rest;
  };
  std::vector<Token> tokens;
  std::array<std::uint32_t, kFields> counted = {};
  std::array<std::uint32_t, kFields> bare = {};
  std::stringstream text(config.mapping);
  for (std::string token; std::getline(text, token, ':');) {
    const std::size_t dot = token.find('.');
    const std::string name = token.substr(0, dot);
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end())
      refuse(fmt::format("fields row, rank, bank, group, column, channel; '{}' is none", token));
    const auto field = static_cast<Field>(found - kNames.begin());
    std::uint32_t bits = 0;
    if (dot != std::string::npos) {
      const std::string digits = token.substr(dot + 1);
      if (digits.empty() || digits.size() > 2 ||
          digits.find_first_not_of("0123456789") != std::string::npos)
        refuse(fmt::format("a number of bits after the dot of '{}'", token));
      bits = static_cast<std::uint32_t>(std::stoul(digits));
      counted[field] += bits;
    } else {
      ++bare[field];
    }
    tokens.push_back({field, bits, dot == std::string::npos});
  }
  for (std::size_t f = 0; f < kFields; ++f) {
    if (bare[f] > 1) refuse(fmt::format("'{}' without a number at most once", kNames[f]));
    if (counted[f] > sizes[f] || (bare[f] == 0 && counted[f] != sizes[f]))
      refuse(fmt::format("{} bits of {}, got {}", sizes[f], kNames[f], counted[f]));
  }

  std::array<std::uint32_t, kFields> placed = {};
  for (auto token = tokens.rbegin(); token != tokens.rend(); ++token) {
    const std::uint32_t bits =
        token->rest ? sizes[token->field] - counted[token->field] : token->bits;
    if (bits == 0) continue;
    pieces_.push_back({token->field, bits, (1u << bits) - 1, placed[token->field]});
    placed[token->field] += bits;
  }

  burst_bits_ = log2_of(memspec.burst_bytes());
  bank_mask_ = memspec.organisation.banks - 1;
  xor_banks_ = config.bank_hash == BankHash::kXor;
  capacity_bytes_ = memspec.rank_bytes() * config.ranks * config.buses(memspec);
  run_bytes_ = memspec.burst_bytes();
  for (const Piece& piece : pieces_) {
    if (piece.field != kColumn) break;
    run_bytes_ <<= piece.bits;
  }
}

std::uint64_t AddressMapping::encode(const DramAddress& place) const {
  std::uint32_t field[kFields];
  field[kRow] = place.row;
  field[kRank] = place.rank;
  const std::uint32_t bank = xor_banks_ ? place.bank ^ (place.row & bank_mask_) : place.bank;
  field[kBank] = bank >> group_bits_;
  field[kGroup] = bank & ((1u << group_bits_) - 1);
  field[kColumn] = place.burst;
  field[kChannel] = place.channel;
  std::uint64_t address = 0;
  std::uint32_t at = burst_bits_;
  for (const Piece& piece : pieces_) {
    address |= std::uint64_t{(field[piece.field] >> piece.to) & piece.mask} << at;
    at += piece.bits;
  }
  return address;
}

}  // namespace sgs

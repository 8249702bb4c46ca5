// Bytes with their long runs of zeros in short: packed scenes are mostly the padding of regions, in
// which a mutation finds nothing.
#pragma once

#include <algorithm>
#include <string>

namespace sgs::test {

// 0xc5 and n: 16 n zeros; 0xc5 and 0: itself.
constexpr char kRun = '\xc5';
constexpr std::size_t kRunBytes = 16;

inline std::string without_runs(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t zeros = std::min(bytes.find_first_not_of('\0', at), bytes.size()) - at;
    const std::size_t runs = std::min<std::size_t>(zeros / kRunBytes, 255);
    if (runs > 0) {
      out += {kRun, static_cast<char>(runs)};
      at += runs * kRunBytes;
      continue;
    }
    out += bytes[at];
    if (bytes[at] == kRun) out += '\0';
    ++at;
  }
  return out;
}

// The inverse; of any bytes.
inline std::string with_runs(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (bytes[at] != kRun || at + 1 == bytes.size()) {
      out += bytes[at];
      continue;
    }
    const auto runs = static_cast<unsigned char>(bytes[++at]);
    out += runs == 0 ? std::string(1, kRun) : std::string(runs * kRunBytes, '\0');
  }
  return out;
}

}  // namespace sgs::test

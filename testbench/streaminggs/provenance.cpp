// Hash, command line, memory.
#include "testbench/streaminggs/provenance.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace sgs {

std::uint64_t fnv1a64(const std::vector<std::byte>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash = (hash ^ word) * 0x100000001b3U;
  }
  return hash;
}

std::uint64_t fnv1a64_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(file ? static_cast<std::size_t>(file.tellg()) : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return fnv1a64(bytes);
}

std::string digest_of_files(const std::vector<std::string>& paths) {
  std::vector<std::byte> hashes;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) continue;
    const std::uint64_t hash = fnv1a64_of_file(path);
    const auto* const bytes = reinterpret_cast<const std::byte*>(&hash);
    hashes.insert(hashes.end(), bytes, bytes + sizeof hash);
  }
  return fmt::format("{:016x}", fnv1a64(hashes));
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  while (!line.empty() && line.back() == '\0') line.pop_back();
  std::replace(line.begin(), line.end(), '\0', ' ');
  return line;
}

std::uint64_t peak_rss_bytes() {
  rusage self{}, children{};
  getrusage(RUSAGE_SELF, &self);
  getrusage(RUSAGE_CHILDREN, &children);
  constexpr std::uint64_t kKiB = 1024;
  return static_cast<std::uint64_t>(std::max(self.ru_maxrss, children.ru_maxrss)) * kKiB;
}

}  // namespace sgs

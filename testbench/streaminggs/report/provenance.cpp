// Hash, command line, memory.
#include "testbench/streaminggs/report/provenance.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace sgs {

std::uint64_t xxh64(const void* bytes, std::size_t count) { return XXH64(bytes, count, 0); }
std::uint64_t xxh64(const std::vector<std::byte>& bytes) {
  return xxh64(bytes.data(), bytes.size());
}

std::uint64_t xxh64_of_text(const std::string& text) { return xxh64(text.data(), text.size()); }

std::uint64_t xxh64_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(file ? static_cast<std::size_t>(file.tellg()) : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return xxh64(bytes);
}

std::string digest_of_files(const std::vector<std::string>& paths) {
  std::vector<std::byte> hashes;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) continue;
    const std::uint64_t hash = xxh64_of_file(path);
    const auto* const bytes = reinterpret_cast<const std::byte*>(&hash);
    hashes.insert(hashes.end(), bytes, bytes + sizeof hash);
  }
  return fmt::format("{:016x}", xxh64(hashes));
}

std::string text_of(const Camera& camera) {
  std::string text = fmt::format("{} {}x{} {} {}", camera.id, camera.width, camera.height,
                                 camera.focal_x, camera.focal_y);
  for (int i = 0; i < 3; ++i) {
    text += fmt::format(" {}", camera.position[i]);
    for (int j = 0; j < 3; ++j) text += fmt::format(" {}", camera.world_from_camera[i][j]);
  }
  if (camera.principal_offset != glm::dvec2(0)) {
    text += fmt::format(" {} {}", camera.principal_offset.x, camera.principal_offset.y);
  }
  if (camera.eyes_apart != 0) text += fmt::format(" eyes {}", camera.eyes_apart);
  return text + " " + camera.name;
}

std::string quoted_for_shell(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string("@%+=:,./-_").find(static_cast<char>(c)) != std::string::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line, word;
  while (std::getline(file, word, '\0')) line += (line.empty() ? "" : " ") + quoted_for_shell(word);
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

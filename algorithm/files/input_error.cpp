// Escaping and cutting of messages.
#include "algorithm/files/input_error.h"

#include <fmt/format.h>

#include <cstdint>

namespace sgs {
namespace {

// Bytes of the UTF-8 character that `text` begins with; 0 for what is none or controls a terminal.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // U+0080 to U+009F are control characters of their own.
  return first == 0xc2 && byte(1) < 0xa0 ? 0 : bytes;
}

void append_escaped(std::string_view text, std::string& out) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes > 0) {
      out += text.substr(0, bytes);
      text.remove_prefix(bytes);
      continue;
    }
    switch (const char byte = text.front()) {
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        out += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(byte));
    }
    text.remove_prefix(1);
  }
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string out;
  if (text.size() <= kMostMessageBytes) {
    append_escaped(text, out);
    return out;
  }
  constexpr std::size_t kHead = kMostMessageBytes / 2, kTail = kMostMessageBytes / 4;
  append_escaped(text.substr(0, kHead), out);
  out += fmt::format(" ... ({} bytes left out) ... ", text.size() - kHead - kTail);
  append_escaped(text.substr(text.size() - kTail), out);
  return out;
}

}  // namespace sgs

// Where a result comes from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

// XXH64 with seed 0, as `xxhsum` prints it: tells whether two runs were fed the same bytes.
std::uint64_t xxh64(const void* bytes, std::size_t count);
std::uint64_t xxh64(const std::vector<std::byte>& bytes);
// Hash of a text.
std::uint64_t xxh64_of_text(const std::string& text);
// Hash of a file; where it cannot be read, that of no bytes.
std::uint64_t xxh64_of_file(const std::string& path);
// Digest of those among these paths that are files, in this order, as a text.
std::string digest_of_files(const std::vector<std::string>& paths);

// All that a picture depends on of a camera, and its name, as a text.
std::string text_of(const Camera& camera);

// A word as a shell takes it: in quotes where it holds more than letters, digits and @%+=:,./-_
std::string quoted_for_shell(const std::string& word);

// This process' command line, as a shell takes it.
std::string command_line();

// Largest resident set of this process and of those that it has waited for.
std::uint64_t peak_rss_bytes();

}  // namespace sgs

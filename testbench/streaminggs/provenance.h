// Where a result comes from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sgs {

// FNV-1a over 64-bit words, the last filled up with zeros: tells whether two runs were fed the same
// bytes.
std::uint64_t fnv1a64(const std::vector<std::byte>& bytes);
// Of a file's.
std::uint64_t fnv1a64_of_file(const std::string& path);
// Of those among these that are files, in this order, as a text.
std::string digest_of_files(const std::vector<std::string>& paths);

// This process' command line, its arguments separated by spaces.
std::string command_line();

// Largest resident set of this process and of those that it has waited for.
std::uint64_t peak_rss_bytes();

}  // namespace sgs

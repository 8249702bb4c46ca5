// Streams of gzip and of zstd whose sizes are known beforehand. No more room is made than the
// compressed bytes can fill.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sgs {

// The beginning of what a gzip stream holds, at most `most_bytes`. origin: for messages. Throws
// InputError for damaged streams.
std::string gunzipped_start(const std::string& origin, std::string_view gzip,
                            std::uint64_t most_bytes);

// All of it. Throws InputError also where it is not of `size_bytes`, or where something follows.
std::string gunzipped(const std::string& origin, std::string_view gzip, std::uint64_t size_bytes);

// All that the zstd frames hold; the same holds.
std::string unzstd(const std::string& origin, std::string_view zstd, std::uint64_t size_bytes);

}  // namespace sgs

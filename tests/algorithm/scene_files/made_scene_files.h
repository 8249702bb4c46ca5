// Small scene files put together byte by byte, independently of the readers under test. Gaussian i
// is made of the numbers code(i, field), which are as large as the format's fields.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace sgs::test {

// One of 256, different for neighbours.
inline std::uint32_t code(std::size_t index, std::size_t field) {
  return static_cast<std::uint32_t>((index * 37 + field * 53 + 11) % 256);
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(&bytes[at], &value, sizeof value);
}
inline void put_byte(std::string& bytes, std::uint32_t value) { bytes += static_cast<char>(value); }

inline int rest_count(int degree) { return 3 * ((degree + 1) * (degree + 1) - 1); }

// Centre (i, -i, 0.5), scales 0.5, 0.25, 2; colour code(i, 0..2), opacity code(i, 3), rotation
// code(i, 4..7).
std::string splat_bytes(std::size_t count);

// Chunk c: x in [-1 - c, 3 + c], y and z in [0, 1]; scales in [-8, -1]; colours in [0, 1] if
// `bounded`, else without bounds. Words: position and scale 8 code(i, 0..2) in 11 bits each (4 for
// y), rotation 4 code(i, 3..5) with largest component i % 4, colour and opacity code(i, 6..9), SH
// code(i, 10..).
std::string compressed_ply_bytes(std::size_t count, int degree, bool bounded);

// Coordinates 256 code(i, 0..2) - 20000 in 24 bits with 12 of them fractional (version 1: half
// precision of code(i, 0..2)), opacity code(i, 3), colour code(i, 4..6), scale code(i, 7..9),
// rotation code(i, 10..12) (from version 3 on two of each, sign and magnitude, largest component
// i % 4), SH code(i, 13..).
std::string spz_bytes(std::uint32_t version, std::size_t count, int degree);
// Versions 1 to 3 without gzip.
std::string bare_spz_bytes(std::uint32_t version, std::size_t count, int degree);
std::string gzip_bytes(const std::string& bytes);

// One section; buckets of 4, the last one not full, around (10 b, 0, -b). Centres of compression 0:
// (i, 2 i, 3 i); else steps 256 code(i, 0..2) of a block of 5 units. Scales 0.5, 0.25, 2, rotation
// (0.5, -0.5, 0.5, 0.5), colour and opacity code(i, 3..6), SH as numbers n of a record: n / 64 - 1,
// in 8 bits code(i, 7 + n).
std::string ksplat_bytes(int compression, std::size_t count, int degree);

// Parts of a SOG by name. Codebooks: scales k / 64 - 5, colours k / 128 - 1, SH k / 256 - 0.5.
// Means from -2 to 2, low bytes code(i, 0..2), high bytes code(i, 3..5); rotation code(i, 6..8)
// with largest component i % 4; scales code(i, 9..11); colours and opacity code(i, 12..15); label i
// % 3 of a palette whose entry e has numbers code(e, 20 + 3 k + channel).
struct Part {
  std::string name, bytes;
};
std::vector<Part> sog_parts(std::size_t count, int degree);
std::string zip_bytes(const std::vector<Part>& parts);
// A lossless picture of so many RGBA pixels, 4 a row.
std::string webp_bytes(std::vector<std::uint8_t> rgba, int width);

// A .glb: centre (i, 2 i, 3 i), quaternion (0.5, 0.5, -0.5, 0.5) as x y z w, scales 0.5, 0.25, 2,
// opacity code(i, 0) / 255, SH coefficient k of channel c: i + k + c / 4. node: its JSON members
// beside "mesh".
std::string glb_bytes(std::size_t count, int degree, const std::string& node = "");
std::string glb_of(const std::string& json, const std::string& binary);
// The same with an SPZ in it.
std::string spz_glb_bytes(const std::string& spz);

}  // namespace sgs::test

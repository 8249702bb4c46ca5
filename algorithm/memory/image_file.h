// The memory image of a scene as a file: everything that the accelerator reads, and what a report
// says of the scene. All numbers little-endian; one header, the image's bytes, a checksum:
//
//   offset  bytes  field
//        0      8  magic 89 53 47 53 0d 0a 1a 0a ("\x89SGS\r\n\x1a\n": text mode would change it)
//        8      4  version, 1
//       12      4  header bytes h, from offset 0
//       16      8  length of the file
//       24         fields of image_file_fields.h, in that order
//             0..255  name of the scene, up to h
//        h         MemoryImage::bytes
//      end - 4  4  CRC-32 (ISO-HDLC, as zlib and PNG) of all bytes before it
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/memory/memory_image.h"
#include "algorithm/vq/codebooks.h"

namespace sgs {

constexpr const char* kImageFileExtension = ".sgs";
constexpr std::uint32_t kImageFileVersion = 1;
constexpr std::size_t kMostNameBytes = 255;

// Of a stored scene, beside its image.
struct PackedFacts {
  std::string name;                   // cut to kMostNameBytes in the file
  std::uint64_t gaussians = 0;        // in the scene, stored or not
  std::uint64_t dropped_invalid = 0;  // before that, because a value was not finite
  Stored stored = Stored::kVisible;
  std::uint32_t chunk_gaussians = 0;  // most in a chunk; 0 by voxels
  VqConfig vq;                        // with which codebooks were made, or would have been
};

struct PackedScene {
  PackedFacts facts;
  MemoryImage image;
  std::uint32_t checksum = 0;
};

// Whether a path ends in kImageFileExtension.
bool is_image_file(const std::string& path);

// image: spill and frame buffer still empty. Appears under `path` once it is complete. Throws
// InputError when `path` cannot be created and std::runtime_error when it cannot be written.
void write_image_file(const std::string& path, const PackedFacts& facts, const MemoryImage& image);

// Throws InputError: not such a file, of another version, shorter or longer than it says, changed
// (checksum), or with a header whose numbers do not fit each other. What the tables and records say
// is checked by restore_scene (restore_scene.h).
PackedScene read_image_file(const std::string& path);

}  // namespace sgs

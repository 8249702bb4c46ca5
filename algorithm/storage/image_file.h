// A stored scene as a file: its bytes in memory, how it was stored, and what a report says of it.
// All numbers little-endian; one header, the image's bytes, a checksum:
//
//   offset  bytes  field
//        0      8  magic 89 53 47 53 0d 0a 1a 0a ("\x89SGS\r\n\x1a\n": text mode would change it)
//        8      4  version, 5
//       12      4  header bytes h, from offset 0
//       16      8  length of the file
//       24         fields of image_file_fields.h, those of the scene's storage order, in that order
//             0..255  name of the scene, up to h
//        h         MemoryImage::bytes
//      end - 4  4  CRC-32 (ISO-HDLC, as zlib and PNG) of all bytes before it
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/storage_config.h"

namespace sgs {

constexpr const char* kImageFileExtension = ".sgs";
constexpr std::uint32_t kImageFileVersion = 5;
constexpr std::size_t kMostNameBytes = 255;

// Facts about a scene, whichever way it is stored.
struct PackedFacts {
  std::string name;                   // cut to kMostNameBytes in the file
  std::uint64_t gaussians = 0;        // in the scene, stored or not
  std::uint64_t dropped_invalid = 0;  // before that, because a value was not finite
  int sh_bands_left_out = 0;          // bands of the scene that storage.sh_tolerance spared
};

struct PackedScene {
  PackedFacts facts;
  StorageConfig storage;  // nothing left to be chosen; the sizes of other orders are not kept
  MemoryImage image;
  std::uint32_t checksum = 0;
};

// True if a path ends in kImageFileExtension.
bool is_image_file(const std::string& path);

// image: stored as `storage` says. Appears under `path` once it is complete. Throws InputError when
// `path` cannot be created and std::runtime_error when it cannot be written.
void write_image_file(const std::string& path, const PackedFacts& facts,
                      const StorageConfig& storage, const MemoryImage& image);

// Throws InputError: not such a file, of another version, shorter or longer than it says, changed
// (checksum), or with a header whose numbers do not fit each other. The contents of tables and
// records are checked by restore_scene (stored_scene.h).
PackedScene read_image_file(const std::string& path);

}  // namespace sgs

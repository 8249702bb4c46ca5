// The forms of scene files, one source file each; README.md has their table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// Compressed PLY of SuperSplat and splat-transform.

// Elements chunk (bounds of 256 Gaussians each), vertex (four words a Gaussian: 11, 10 and 11 bits
// of position and of scale within the bounds, 10 bits for each of the three smaller components of
// the quaternion, 8 bits for colour and opacity) and perhaps sh (8 bits a coefficient). Throws
// InputError as read_ply_header does, for missing properties, counts that do not fit each other,
// bytes behind the last record, other kinds (ply_header.h), and as decoded_scene does.
SceneContents read_compressed_ply(const std::string& path, const SceneReadOptions& options);

// Niantic's .spz, versions 1 to 4.

// A header of 16 B, then all centres (24 bits a coordinate; version 1: half precision), opacities,
// colours, scales (8 bits each), quaternions (8 bits a component; from version 3 on the three
// smaller ones in 10 bits each) and SH coefficients (8 bits), in one gzip stream or bare. Version
// 4: a header of 32 B, extensions, and a zstd stream for each of these. Throws InputError for other
// versions and flags, SH degree 4, sizes that do not fit the header, damaged streams and
// extensions, and as decoded_scene does.
SceneContents read_spz(const std::string& path, const SceneReadOptions& options);

// The same of bytes within another file. origin: that file and the place, for messages.
SceneContents read_spz_bytes(const std::string& origin, std::string_view bytes,
                             const SceneReadOptions& options);

// glTF 2.0: .glb and .gltf with KHR_gaussian_splatting.

// All primitives with the extension of the scene that is shown, each moved by its node, from
// accessors of float or integers, or from an SPZ in a buffer view
// (KHR_gaussian_splatting_compression_spz_2). glTF has its y axis upward: the result is turned half
// about z, back to the axes of an INRIA .ply, as splat-transform turns it for glTF. Throws
// InputError for other kernels, colour spaces, compressions and required extensions, nodes that do
// more than turn, move and scale alike, whatever does not fit its buffer, and as decoded_scene
// does.
SceneContents read_gltf(const std::string& path, const SceneReadOptions& options);
std::vector<std::string> files_of_gltf(const std::string& path, const SceneReadOptions& options);

// SOG of PlayCanvas, version 2, in a folder or a .zip, and streamed in levels of detail.

constexpr const char* kSogMeta = "meta.json";
constexpr const char* kStreamedSogMeta = "lod-meta.json";

// One of the two files above by its name, or a folder that holds it.
bool is_sog_folder(const std::string& path);
bool is_streamed_sog(const std::string& path);

// meta.json and WebP pictures, a pixel a Gaussian: centres (16 bits a coordinate, of a logarithm),
// quaternions (the three smaller components in 8 bits each), scales and colours (8-bit indices of
// codebooks), opacities, and SH coefficients (indices of a palette). path: of a zip, of meta.json,
// or of its folder. Throws InputError for other versions, what is missing or damaged, pictures with
// too few pixels, and as decoded_scene does.
SceneContents read_sog(const std::string& path, const SceneReadOptions& options);
std::vector<std::string> files_of_sog(const std::string& path, const SceneReadOptions& options);

// lod-meta.json and the SOG folders that it names: those of one level. Throws InputError also for a
// level that it has not.
SceneContents read_streamed_sog(const std::string& path, const SceneReadOptions& options);
std::vector<std::string> files_of_streamed_sog(const std::string& path,
                                               const SceneReadOptions& options);

// .splat of antimatter15's web viewer, and .ksplat of GaussianSplats3D's.

// 32 B a Gaussian, nothing before or behind: centre and scale as floats, colour and opacity of 8
// bits, quaternion of 8 bits a component. Throws InputError for other sizes, and as decoded_scene
// does.
SceneContents read_splat(const std::string& path, const SceneReadOptions& options);

// A header of 4 KiB, headers of sections of 1 KiB each, then the sections: buckets of Gaussians
// around a centre, and a record for each. Compression 0 keeps floats; 1 has centres of 16 bits
// within the bucket and half precision; 2 has SH coefficients of 8 bits, too. Throws InputError
// for other versions and compressions, sizes that do not fit the headers, and as decoded_scene
// does.
SceneContents read_ksplat(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs

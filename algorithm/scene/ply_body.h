// The records of a PLY file, in binary and in text.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/files/input_file.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {

// Both fill `cloud`, already resized to the count of element number `vertex_element` of `header`,
// and return the vertices that cannot be used, ascending. They throw InputError when the file ends
// before the last record of any element, with a record that cannot be read, or goes on behind it.

// Runs on all threads; binary of either byte order.
std::vector<VertexFault> read_binary_vertices(const InputFile& file, const PlyHeader& header,
                                              std::size_t vertex_element,
                                              const VertexLayout& layout, GaussianCloud& cloud);

// One record a line, values separated by blanks; empty lines are skipped.
std::vector<VertexFault> read_ascii_vertices(const InputFile& file, const PlyHeader& header,
                                             std::size_t vertex_element, const VertexLayout& layout,
                                             GaussianCloud& cloud);

}  // namespace sgs

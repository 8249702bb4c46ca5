// The reader of ply_reader.h: header, layout, records, faults.
#include "algorithm/scene/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_body.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {

PlyReadResult read_ply(const std::string& path, const PlyReadOptions& options) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  const auto vertex =
      std::find_if(header.elements.begin(), header.elements.end(),
                   [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertex == header.elements.end()) {
    throw InputError(fmt::format("{}: line {}: the header has no element vertex, expected one",
                                 path, header.line_count));
  }
  const auto vertex_element = static_cast<std::size_t>(vertex - header.elements.begin());
  const VertexLayout layout = layout_of_vertex(path, *vertex);

  PlyReadResult result;
  result.cloud.resize(vertex->count, layout.sh_degree);
  const auto read_vertices =
      header.format == PlyFormat::kAscii ? read_ascii_vertices : read_binary_vertices;
  const std::vector<VertexFault> faults =
      read_vertices(file, header, vertex_element, layout, result.cloud);
  if (faults.empty()) return result;
  if (!options.drop_invalid) throw InputError(describe_fault(path, faults.front()));
  remove_faulty(faults, result.cloud);
  result.dropped_invalid = faults.size();
  return result;
}

}  // namespace sgs

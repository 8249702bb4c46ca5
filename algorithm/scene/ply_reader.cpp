// The reader of ply_reader.h: header, layout, records, faults.
#include "algorithm/scene/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_body.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_kinds.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {

SceneContents read_ply(const std::string& path, const SceneReadOptions& options) {
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
  refuse_other_kinds(path, header, *vertex);
  const VertexLayout layout = layout_of_vertex(path, *vertex);

  SceneContents result;
  result.notes = notes_on_ply(header, *vertex);
  result.cloud.resize(vertex->count, layout.sh_degree);
  const auto read_vertices =
      header.format == PlyFormat::kAscii ? read_ascii_vertices : read_binary_vertices;
  const std::vector<VertexFault> faults =
      read_vertices(file, header, vertex_element, layout, result.cloud);
  settle_faults(path, faults, options, result);
  return result;
}

}  // namespace sgs

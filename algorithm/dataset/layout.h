// The choice of a data set's layout, by the files that are there.
#pragma once

#include <string>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

struct Layout {
  const char* name;        // for people
  const char* key;         // of DatasetOptions
  const char* looked_for;  // file or files
  bool (*holds)(const std::string& folder);
  // As in layouts.h.
  StatedDataset (*read)(const std::string& folder);
};

// The layout with this key, or where it is empty the only one that `folder` holds; a model of
// COLMAP that may lie beside other layouts counts where nothing else is there. Throws InputError:
// no such folder, no layout (says what was looked for) or more than one (names them), an unknown
// key, a key of a layout that is not there.
const Layout& layout_of(const std::string& folder, const std::string& key);

}  // namespace sgs

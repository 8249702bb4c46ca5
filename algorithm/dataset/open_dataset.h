// A data set out of a folder.
#pragma once

#include <string>

#include "algorithm/dataset/dataset.h"

namespace sgs {

// Reads cameras, points and the headers of all images below `folder`; no pixel yet. Views are
// `downscale` times smaller than their files, as downscaled_camera() makes them. The layout is
// recognised by the files that are there. Test views are the data set's own, or every 8th in the
// order of names, from the first, as the original takes them. Throws InputError: no such folder, no
// layout or more than one (says what was looked for), what the readers in layouts.h and
// complete_view() refuse, a name twice, no view to train from, a downscale that is not from 1.
Dataset open_dataset(const std::string& folder, double downscale = 1);

// Throws InputError where there is none, with what was to name them.
void require_test_views(const Dataset& dataset);

}  // namespace sgs

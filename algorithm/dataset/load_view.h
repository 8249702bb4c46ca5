// The pixels of a view, when they are wanted.
#pragma once

#include "algorithm/dataset/dataset.h"
#include "algorithm/image/rgba_image.h"

namespace sgs {

// The view's camera for an image `downscale` times smaller still, each side rounded, at least 1 px.
// Throws InputError unless downscale is finite and from 1.
Camera downscaled_camera(const DatasetView& view, double downscale);

// The view's image as that camera sees it, each pixel the mean over its area of the file. Throws
// InputError as read_photograph() and downscaled_camera() do, and when the file has changed its
// size since the data set was opened. Several threads may load at once.
RgbaImage load_view(const DatasetView& view, double downscale = 1);

}  // namespace sgs

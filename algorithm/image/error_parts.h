// A squared error divided among the steps that led to it.
#pragma once

#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// The part of one step in the error of all.
struct ErrorPart {
  double share = 0;  // in the squared error; below 0 where the step takes back what others add
  double alone = 0;  // its own square over the squared error; never below 0
};

// chain: at least two pictures; each is the one before it and one more step of loss. Returns a part
// for each step. Pictures are clamped to [0, 1] first, as for PSNR. With d_i the difference that
// step i makes, e their sum (last picture minus first) and <,> the sum over pixels and channels:
//
//   <e, e> = sum_i <d_i, d_i> + sum_{i<j} 2 <d_i, d_j>
//   share_i = <d_i, e> / <e, e>      alone_i = <d_i, d_i> / <e, e>
//
// A share is the step's own square and one half of each cross term that it has a part in, so shares
// add up to 1. The squares alone do not: 1 - sum_i alone_i is what all cross terms come to. NaN
// where the ends of the chain are equal or a picture holds NaN. Throws InputError when the pictures
// differ in size or have no pixels.
std::vector<ErrorPart> error_parts(const std::vector<const Image*>& chain);

}  // namespace sgs

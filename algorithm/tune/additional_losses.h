// The two losses that a tuning may add to the photometric one.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/projection.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// The cross-boundary penalty of StreamingGS (DAC 2025), L_CBP = 1/N sum_i T_i S_i: Gaussians that
// are blended out of order, by their size. T_i = 1 where depth_i is below the largest depth of the
// Gaussians rendered before it, S_i is its largest scale. For each view and group of pixels, the
// running maximum beginning anew with each group; a Gaussian counts in each group in which it is
// rendered, which is: blended into some pixel.

// The Gaussians before which one is out of order: the paper says no more than "rendered before it".
// kGroup: anywhere in the group. kPixel: at one of the pixels that it is blended into itself, which
// is where it costs something.
enum class MisorderedIn { kGroup, kPixel };

// N, which the paper leaves open too, counts the (group, Gaussian) pairs that are rendered, or the
// Gaussians of the scene.
enum class PenaltyMean { kRendered, kScene };

struct BoundaryPenaltyConfig {
  MisorderedIn in = MisorderedIn::kGroup;
  PenaltyMean mean = PenaltyMean::kRendered;
};

struct BoundaryPenalty {
  double value = 0;                   // L_CBP, world units
  double count = 0;                   // N
  std::uint64_t rendered = 0;         // (group, Gaussian) pairs
  std::uint64_t misordered = 0;       // misordered pairs among these
  std::vector<std::uint32_t> groups;  // [splats] in how many T_i = 1
};

// sequences: of this cloud. The same bits whatever the number of threads.
BoundaryPenalty boundary_penalty(const GroupSequences& sequences, const ActivatedCloud& cloud,
                                 BlendPrecision precision, const BoundaryPenaltyConfig& config);

// Adds beta dL_CBP/dlog_scale. T_i is a decision and has no derivative. gradient: of a picture of
// these sequences, so that all that is rendered has a row in it.
void add_boundary_gradient(const BoundaryPenalty& penalty, double beta,
                           const GroupSequences& sequences, const ActivatedCloud& cloud,
                           CloudGradient& gradient);

// The price of streaming a Gaussian: in each view its record is fetched for every group of pixels
// that it may be seen in. The price can be differentiated, so that a tuning can lower it.

template <class T>
struct StreamingPrice {
  T value;
  SplatGradient<T> by_splat;  // gradient of `value`
};

// Opacity at half of the whole price.
constexpr double kHalfPriced = 0.05;

// The groups that a box of its visible half-sides k sqrt(cov) meets on average,
// (1 + 2 k sqrt(cov_a) / width) (1 + 2 k sqrt(cov_c) / height), k = sqrt(2 ln(255 opacity)), each
// factor no more than the frame has columns or rows, where it has no derivative; times
// opacity / (opacity + 0.05). 0 for what is never visible. By that factor the faint are the first
// to go, while the opaque, who are fetched whatever little they get fainter, are left alone.
template <class T>
StreamingPrice<T> streaming_price(const Projected<T>& p, T opacity, const PixelSize& group,
                                  const PixelSize& frame) {
  const T zero = T(0.0F), one = T(1.0F), two = T(2.0F);
  StreamingPrice<T> out{zero, {}};
  const T cutoff = visible_cutoff(opacity);
  if (!(cutoff > zero)) return out;
  const T k = sqrt_of(cutoff);
  struct Side {
    T groups, by_cov, by_k;
  };
  const auto side_of = [&](T cov, int group_px, int frame_px) {
    const T sigma = sqrt_of(cov), per_px = T(two / constant<T>(group_px));
    const T groups = T(one + per_px * k * sigma);
    const T most = constant<T>((frame_px + group_px - 1) / group_px);
    if (most < groups) return Side{most, zero, zero};
    return Side{groups, T(per_px * k / T(two * sigma)), T(per_px * sigma)};
  };
  const Side x = side_of(p.cov_a, group.width, frame.width);
  const Side y = side_of(p.cov_c, group.height, frame.height);
  const T half = constant<T>(kHalfPriced), sum = T(opacity + half);
  const T paid = T(opacity / sum);
  out.value = T(paid * x.groups * y.groups);
  out.by_splat.cov_a = T(paid * x.by_cov * y.groups);
  out.by_splat.cov_c = T(paid * y.by_cov * x.groups);
  // dk/dopacity = 1 / (k opacity).
  out.by_splat.opacity = T(half / T(sum * sum) * x.groups * y.groups +
                           paid * T(x.by_k * y.groups + y.by_k * x.groups) / T(k * opacity));
  return out;
}

// Adds weight dP/dparameters, P = 1/N sum of the prices of the splats of these sequences, N all
// Gaussians of the cloud; returns P. A splat that the picture shows nowhere, behind others or on no
// pixel, is fetched too, and gets a row. cloud: activate(parameters). The same bits whatever the
// number of threads.
double add_streaming_gradient(const View<float>& view, const GroupSequences& sequences,
                              const GaussianCloud& parameters, const ActivatedCloud& cloud,
                              const PixelSize& group, double weight, CloudGradient& gradient);

}  // namespace sgs

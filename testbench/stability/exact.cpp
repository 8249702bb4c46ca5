#include "testbench/stability/exact.h"

#include <boost/math/constants/constants.hpp>

namespace sgs {

namespace {

Exact clamped(const Exact& x, const Exact& limit) {
  if (x < -limit) return -limit;
  return x > limit ? limit : x;
}

ExactMatrix rotation(const std::array<Exact, 4>& q) {
  const Exact &w = q[0], &x = q[1], &y = q[2], &z = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace

ExactVector exact_colour(int degree, const std::vector<ExactVector>& coeffs,
                         const ExactVector& offset) {
  static const Exact pi = boost::math::constants::pi<Exact>();
  const auto root = [](int numerator, int denominator) {
    return Exact(sqrt(Exact(numerator) / (denominator * pi)));
  };
  // sqrt(n / (d pi)) of each kind of polynomial.
  static const Exact f0 = root(1, 4), f1 = root(3, 4), f2 = root(15, 4), f2z = root(5, 16),
                     f2d = root(15, 16), f3 = root(35, 32), f3p = root(105, 4), f3y = root(21, 32),
                     f3z = root(7, 16), f3d = root(105, 16);
  const Exact size = degree > 0 ? length(offset) : Exact(1);
  const Exact x = offset[0] / size, y = offset[1] / size, z = offset[2] / size;
  const Exact basis[16] = {f0,
                           -f1 * y,
                           f1 * z,
                           -f1 * x,
                           f2 * x * y,
                           -f2 * y * z,
                           f2z * (2 * z * z - x * x - y * y),
                           -f2 * x * z,
                           f2d * (x * x - y * y),
                           -f3 * y * (3 * x * x - y * y),
                           f3p * x * y * z,
                           -f3y * y * (4 * z * z - x * x - y * y),
                           f3z * z * (2 * z * z - 3 * x * x - 3 * y * y),
                           -f3y * x * (4 * z * z - x * x - y * y),
                           f3d * z * (x * x - y * y),
                           -f3 * x * (x * x - 3 * y * y)};
  ExactVector colour{Exact(1) / 2, Exact(1) / 2, Exact(1) / 2};
  for (std::size_t k = 0; k < coeffs.size(); ++k) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      colour[channel] += basis[k] * coeffs[k][channel];
    }
  }
  return colour;
}

ExactView exact_view(const Camera& camera) {
  ExactView view;
  view.position = exact(camera.position);
  for (int row = 0; row < 3; ++row) {
    view.cam_from_world[static_cast<std::size_t>(row)] = exact(camera.world_from_camera[row]);
  }
  view.focal_x = camera.focal_x;
  view.focal_y = camera.focal_y;
  const Exact guard = Exact(13) / 10;
  const Exact off_x = camera.principal_offset.x, off_y = camera.principal_offset.y;
  view.limit_x = guard * camera.width / (2 * view.focal_x) + abs(off_x) / view.focal_x;
  view.limit_y = guard * camera.height / (2 * view.focal_y) + abs(off_y) / view.focal_y;
  view.centre_x = Exact(camera.width - 1) / 2 + off_x;
  view.centre_y = Exact(camera.height - 1) / 2 + off_y;
  return view;
}

ExactVector exact_to_camera(const ExactView& view, const ExactVector& mean) {
  ExactVector offset, v;
  for (std::size_t k = 0; k < 3; ++k) offset[k] = mean[k] - view.position[k];
  for (std::size_t row = 0; row < 3; ++row) v[row] = dot(view.cam_from_world[row], offset);
  return v;
}

void complete(ExactSplat& splat) {
  const Exact &a = splat.cov_a, &b = splat.cov_b, &c = splat.cov_c;
  splat.determinant = a * c - b * b;
  splat.conic_a = c / splat.determinant;
  splat.conic_b = -b / splat.determinant;
  splat.conic_c = a / splat.determinant;
  const Exact mid = (a + c) / 2, least = Exact(1) / 10;
  const Exact discriminant = mid * mid - splat.determinant;
  splat.lambda = mid + sqrt(discriminant > least ? discriminant : least);
}

ExactSplat exact_project(const ExactView& view, const ExactGaussian& g, const ExactVector& v) {
  ExactMatrix m = rotation(g.quat);
  for (ExactVector& row : m) {
    for (std::size_t k = 0; k < 3; ++k) row[k] *= g.scale[k];
  }
  const ExactMatrix sigma = product(m, transposed(m));
  const ExactMatrix in_camera =
      product(product(view.cam_from_world, sigma), transposed(view.cam_from_world));
  const Exact x = clamped(v[0] / v[2], view.limit_x) * v[2];
  const Exact y = clamped(v[1] / v[2], view.limit_y) * v[2];
  const ExactVector jx{view.focal_x / v[2], 0, -view.focal_x * x / (v[2] * v[2])};
  const ExactVector jy{0, view.focal_y / v[2], -view.focal_y * y / (v[2] * v[2])};
  const auto between = [&](const ExactVector& left, const ExactVector& right) {
    return dot(left,
               {dot(in_camera[0], right), dot(in_camera[1], right), dot(in_camera[2], right)});
  };
  const Exact low_pass = Exact(3) / 10;
  ExactSplat out;
  out.x = view.focal_x * v[0] / v[2] + view.centre_x;
  out.y = view.focal_y * v[1] / v[2] + view.centre_y;
  out.depth = v[2];
  out.cov_a = between(jx, jx) + low_pass;
  out.cov_b = between(jx, jy);
  out.cov_c = between(jy, jy) + low_pass;
  complete(out);
  return out;
}

}  // namespace sgs

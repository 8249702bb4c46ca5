// From world to camera to pixel.
#include <glm/geometric.hpp>

#include "testbench/stability/projected_case.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

constexpr double kNearest = 0.5, kFarthest = 50;  // |p - c| where coordinates are swept

template <class T>
Deviation far_from_origin(double coordinate, Random& random) {
  Camera camera = turned_camera(random);
  camera.position = coordinate * random.direction();
  const glm::dvec3 offset = log_uniform(random, kNearest, kFarthest) * random.direction();
  const glm::vec3 mean(camera.position + offset);
  const ExactView view = exact_view(camera);
  const ExactVector v = exact_to_camera(view, exact(mean));
  const auto computed = to_camera(bounded_view<T>(camera), given<T>(mean));
  Deviation worst;
  for (std::size_t k = 0; k < 3; ++k) {
    worst.add(deviation(computed[static_cast<int>(k)], v[k], length(v)));
  }
  return worst;
}

// A centre so far behind the near plane, somewhere in the frame, the camera at the origin.
glm::dvec3 seen_at(double beyond_near, Random& random) {
  const double z = kNearPlane + beyond_near;
  return {random.uniform(-0.6, 0.6) * z, random.uniform(-0.35, 0.35) * z, z};
}

enum class Of { kDepth, kDistance };

template <class T>
Deviation depth(double beyond_near, Random& random, Of of) {
  const Camera camera = turned_camera(random);
  const glm::vec3 mean(camera.world_from_camera * seen_at(beyond_near, random));
  const Exact z = exact_to_camera(exact_view(camera), exact(mean))[2];
  const Exact beyond = abs(z - Exact(1) / 5);
  return deviation(to_camera(bounded_view<T>(camera), given<T>(mean)).z, z,
                   of == Of::kDepth ? z : beyond);
}

template <class T>
Deviation pixel(double beyond_near, Random& random) {
  const Camera camera = turned_camera(random);
  const glm::vec3 v(seen_at(beyond_near, random));
  const auto held = given<T>(v);
  const auto computed = to_pixel(bounded_view<T>(camera), held);
  const ExactView view = exact_view(camera);
  const Exact x(v.x), y(v.y), z(v.z);
  Deviation worst = deviation(computed.x, view.focal_x * x / z + view.centre_x, 1);
  worst.add(deviation(computed.y, view.focal_y * y / z + view.centre_y, 1));
  return worst;
}

}  // namespace

std::vector<Study> camera_studies() {
  const auto key = [](double place, Random& r) {
    return depth<BoundedFloat>(place, r, Of::kDepth);
  };
  const auto key_in_half = [](double place, Random& r) {
    return depth<BoundedHalf>(place, r, Of::kDepth);
  };
  const auto beyond_near = [](double place, Random& r) {
    return depth<BoundedFloat>(place, r, Of::kDistance);
  };
  const auto beyond_near_law = [](double place) {
    return 16 * u * (kNearPlane + 2 * place) / place;
  };
  const char* const near = "distance from the near plane";
  return {
      {"v = R^T (p - c)", "p - c, c as two floats", "float", "coordinates", "of |p - c|",
       decades(0, 8), far_from_origin<BoundedFloat>, flat(12 * u), "12 u",
       "Does not break: the first difference is exact where p and c are close beside their "
       "distance from the origin. What a file's floats leave of p at 10^8 (8 units) is the "
       "file's."},
      {"depth key v_z", "bits of v_z", "float", near, "of v_z", decades(-6, 6), key, flat(16 * u),
       "16 u", "Does not break: splats whose depths differ by a millionth are in order."},
      {"depth key v_z", "bits of v_z", "half", near, "of v_z", decades(-6, 6), key_in_half,
       flat_to(1e4, 16 * h), "16 u",
       "Two splats nearer to each other than 0.3 % of their depth may change places, beyond 65,504 "
       "all are one. Only the preset gscore has such keys."},
      {"v_z > 0.2", "as the key", "float", near, "of |v_z - 0.2|", decades(6, -6), beyond_near,
       beyond_near_law, "16 u v_z / |v_z - 0.2|",
       "Nearer to the plane than 10^-6 a Gaussian may be drawn or not; nothing else computes with "
       "that difference. Keep cameras out of surfaces."},
      {"centre x = f v_x / v_z + c_x", "as written", "float", near, "px", decades(-6, 6),
       pixel<BoundedFloat>, flat(3500 * u), "u (3 |x - c_x| + |x|)",
       "Does not break: 10^-4 px at 1280 x 720, as much more as the frame is wider."}};
}

}  // namespace sgs

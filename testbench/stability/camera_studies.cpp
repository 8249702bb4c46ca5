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
  std::vector<Study> out;

  Study s;
  s.formula = "v = R^T (p - c)";
  s.form = "p - c, c as two floats";
  s.arithmetic = "float";
  s.axis = "coordinates";
  s.unit = "of |p - c|";
  s.places = decades(0, 8);
  s.sample = far_from_origin<BoundedFloat>;
  s.law = [](double) { return 12 * u; };
  s.law_text = "12 u";
  s.why =
      "Does not break: the first difference is exact where p and c are close beside their "
      "distance from the origin. What a file's floats leave of p at 10^8 (8 units) is the file's.";
  out.push_back(s);

  for (const bool in_half : {false, true}) {
    s = {};
    s.formula = "depth key v_z";
    s.form = "bits of v_z";
    s.arithmetic = in_half ? "half" : "float";
    s.axis = "distance from the near plane";
    s.unit = "of v_z";
    s.places = decades(-6, 6);
    s.sample = [in_half](double place, Random& random) {
      return in_half ? depth<BoundedHalf>(place, random, Of::kDepth)
                     : depth<BoundedFloat>(place, random, Of::kDepth);
    };
    s.law = [in_half](double place) {
      if (in_half && place > 1e4) return static_cast<double>(INFINITY);
      return (in_half ? h : u) * 16;
    };
    s.law_text = "16 u";
    s.why =
        in_half
            ? "Two splats nearer to each other than 0.3 % of their depth may change places, beyond "
              "65,504 all are one. Only the preset gscore has such keys."
            : "Does not break: splats whose depths differ by a millionth are in order.";
    out.push_back(s);
  }

  s = out[out.size() - 2];
  s.formula = "v_z > 0.2";
  s.form = "as the key";
  s.unit = "of |v_z - 0.2|";
  s.places = decades(6, -6);
  s.sample = [](double place, Random& random) {
    return depth<BoundedFloat>(place, random, Of::kDistance);
  };
  s.law = [](double place) { return 16 * u * (kNearPlane + 2 * place) / place; };
  s.law_text = "16 u v_z / |v_z - 0.2|";
  s.why =
      "Nearer to the plane than 10^-6 a Gaussian may be drawn or not; nothing else computes with "
      "that difference. Keep cameras out of surfaces.";
  out.push_back(s);

  s = {};
  s.formula = "centre x = f v_x / v_z + c_x";
  s.form = "as written";
  s.arithmetic = "float";
  s.axis = "distance from the near plane";
  s.unit = "px";
  s.places = decades(-6, 6);
  s.sample = pixel<BoundedFloat>;
  s.law = [](double) { return 3500 * u; };
  s.law_text = "u (3 |x - c_x| + |x|)";
  s.why = "Does not break: 10^-4 px at 1280 x 720, as much more as the frame is wider.";
  out.push_back(s);
  return out;
}

}  // namespace sgs

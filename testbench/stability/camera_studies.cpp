// From world to camera to pixel.
#include <glm/geometric.hpp>

#include "testbench/stability/counted.h"
#include "testbench/stability/projected_case.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

constexpr double kNearest = 0.5, kFarthest = 50;  // |p - c| where coordinates are swept

template <class T>
using CameraForm = glm::vec<3, T> (*)(const Camera&, const View<T>&, const glm::vec<3, T>&);

template <class T>
glm::vec<3, T> taken_form(const Camera&, const View<T>& view, const glm::vec<3, T>& p) {
  return to_camera(view, p);
}

template <class T>
glm::vec<3, T> rows_times(const View<T>& view, const glm::vec<3, T>& d) {
  glm::vec<3, T> v;
  for (int row = 0; row < 3; ++row) {
    const auto& axis = view.cam_from_world[row];
    v[row] = T(axis.x * d.x + axis.y * d.y + axis.z * d.z);
  }
  return v;
}

// c as one number of the format.
template <class T>
glm::vec<3, T> one_number(const Camera& camera, const View<T>& view, const glm::vec<3, T>& p) {
  glm::vec<3, T> d;
  for (int k = 0; k < 3; ++k) d[k] = T(p[k] - constant<T>(camera.position[k]));
  return rows_times(view, d);
}

// R^T p + t, t = -R^T c made beforehand.
template <class T>
glm::vec<3, T> world_form(const Camera& camera, const View<T>& view, const glm::vec<3, T>& p) {
  glm::vec<3, T> v = rows_times(view, p);
  const ExactVector zero{0, 0, 0}, t = exact_to_camera(exact_view(camera), zero);
  for (int k = 0; k < 3; ++k) {
    v[k] = T(v[k] + constant<T>(static_cast<double>(t[static_cast<std::size_t>(k)])));
  }
  return v;
}

template <class T>
Deviation far_from_origin(double coordinate, Random& random, CameraForm<T> form) {
  Camera camera = turned_camera(random);
  camera.position = coordinate * random.direction();
  const glm::dvec3 offset = log_uniform(random, kNearest, kFarthest) * random.direction();
  const glm::vec3 mean(camera.position + offset);
  const ExactView view = exact_view(camera);
  const ExactVector v = exact_to_camera(view, exact(mean));
  const auto computed = form(camera, bounded_view<T>(camera), given<T>(mean));
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

std::string operations_of(CameraForm<Counting> form) {
  Random random(1);
  Camera camera = turned_camera(random);
  camera.position = {1.1, 2.9, 3.7};
  const View<Counting> view = make_view<Counting>(camera);
  return counted(
      [&](Counting x, Counting y, Counting z) {
        return form(camera, view, {x, y, z});
      },
      4.1F, 5.3F, 6.7F);
}

template <class T>
Study coordinates(const char* form, bool taken, const char* arithmetic, CameraForm<T> compute) {
  Study s;
  s.formula = "v = R^T (p - c)";
  s.form = form;
  s.taken = taken;
  s.arithmetic = arithmetic;
  s.axis = "coordinates";
  s.unit = "of |p - c|";
  s.places = decades(0, 8);
  s.sample = [compute](double place, Random& random) {
    return far_from_origin<T>(place, random, compute);
  };
  return s;
}

}  // namespace

std::vector<Study> camera_studies() {
  constexpr double u = Single::kRoundoff, h = Half::kRoundoff;
  std::vector<Study> out;

  Study s = coordinates<BoundedFloat>("p - c, c as two floats", true, "float", taken_form);
  s.law = [](double) { return 12 * u; };
  s.law_text = "12 u";
  s.why =
      "Does not break: the first difference is exact where p and c are close beside their "
      "distance from the origin. What a file's floats leave of p at 10^8 (8 units) is the file's.";
  s.operations = operations_of(taken_form);
  out.push_back(s);

  s = coordinates<BoundedFloat>("p - c, c as one float", false, "float", one_number);
  s.law = [](double place) { return 12 * u + 2 * u * place / kNearest; };
  s.law_text = "12 u + u |c| / |p - c|";
  s.why =
      "The camera stands where float puts it: 3 sums less, and details of the picture gone from "
      "10^5 on, "
      "all of it from 10^7.";
  s.operations = operations_of(one_number);
  out.push_back(s);

  s = coordinates<BoundedFloat>("R^T p + t", false, "float", world_form);
  s.law = [](double place) { return 12 * u + 12 * u * place / kNearest; };
  s.law_text = "12 u + 6 u |c| / |p - c|";
  s.why =
      "Sums of the size of |c| cancel to |p - c|: ten times earlier than the form above, for as "
      "many sums.";
  s.operations = operations_of(world_form);
  out.push_back(s);

  s = coordinates<BoundedHalf>("p - c, c as two halves", false, "half", taken_form);
  s.law = [](double place) { return place < 1e4 ? 12 * h + 2 * h * place / kNearest : INFINITY; };
  s.law_text = "12 u + u |p| / |p - c|";
  s.why =
      "Centres as halves are 0.5 % of their distance off 10 units from the origin, 4 % off 100 "
      "units "
      "from it. Centres stay in float. A half would do for offsets from a chunk's corner.";
  out.push_back(s);

  for (const bool in_half : {false, true}) {
    s = {};
    s.formula = "depth key v_z";
    s.form = "bits of v_z";
    s.taken = !in_half;
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
              "65,504 all are one. Keys stay in float; only the preset gscore has halves."
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

  for (const bool in_half : {false, true}) {
    s = {};
    s.formula = "centre x = f v_x / v_z + c_x";
    s.form = "as written";
    s.taken = !in_half;
    s.arithmetic = in_half ? "half" : "float";
    s.axis = "distance from the near plane";
    s.unit = "px";
    s.places = decades(-6, 6);
    s.sample = [in_half](double place, Random& random) {
      return in_half ? pixel<BoundedHalf>(place, random) : pixel<BoundedFloat>(place, random);
    };
    s.law = [in_half](double place) {
      if (in_half && place > 1e4) return static_cast<double>(INFINITY);
      return 3500 * (in_half ? h : u);
    };
    s.law_text = "u (3 |x - c_x| + |x|)";
    s.why = in_half
                ? "A half of 640 px has a last place of half a pixel: centres cannot be halves; "
                  "offsets from a sub-tile can, which is what blending in half takes."
                : "Does not break: 10^-4 px at 1280 x 720, as much more as the frame is wider.";
    out.push_back(s);
  }
  return out;
}

}  // namespace sgs

// Undistorting: the region that a lens sees is a star around its axis; the picture is the largest
// upright box in it whose middle is the axis.
#include "algorithm/dataset/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

constexpr double kNearAxis = 1e-9;  // as close to it the quotients of angles are at their limits

glm::dvec2 perspective(const Lens& lens, const glm::dvec2& at) {
  const auto& k = lens.k;
  const double r2 = glm::dot(at, at);
  const double radial =
      (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
  const double both = 2 * at.x * at.y;
  return at * radial + glm::dvec2(lens.p1 * both + lens.p2 * (r2 + 2 * at.x * at.x),
                                  lens.p1 * (r2 + 2 * at.y * at.y) + lens.p2 * both);
}

double field_of_view(double angle, double r) {
  const double slope = 2 * std::tan(0.5 * angle);
  return r < kNearAxis ? slope / angle : std::atan(r * slope) / (r * angle);
}

double fisheye(const Lens& lens, double r) {
  const auto& k = lens.k;
  if (r < kNearAxis) return 1;
  const double angle = std::atan(r), a2 = angle * angle;
  return angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))) / r;
}

}  // namespace

bool is_pinhole(const Lens& lens) {
  if (lens.kind == LensKind::kFisheye || lens.kind == LensKind::kOther) return false;
  return lens.p1 == 0 && lens.p2 == 0 &&
         std::all_of(lens.k.begin(), lens.k.end(), [](double k) { return k == 0; });
}

glm::dvec2 distorted(const Lens& lens, const glm::dvec2& at) {
  if (is_pinhole(lens)) return at;
  const double r = glm::length(at);
  switch (lens.kind) {
    case LensKind::kDivision:
      return at * (2 / (1 + std::sqrt(1 - 4 * lens.k[0] * r * r)));
    case LensKind::kFov:
      return at * field_of_view(lens.k[0], r);
    case LensKind::kFisheye:
      return at * fisheye(lens, r);
    default:
      return perspective(lens, at);
  }
}

void check_lens(const Lens& lens, const std::string& where) {
  if (lens.kind == LensKind::kOther) {
    throw InputError(
        fmt::format("{}: got the camera model {}, expected a pinhole, OPENCV, RADIAL, FULL_OPENCV, "
                    "FOV, DIVISION, "
                    "OPENCV_FISHEYE, RADIAL_FISHEYE, FISHEYE or a SIMPLE_ one of these",
                    where, lens.model));
  }
  std::array<double, 8> numbers{lens.p1, lens.p2};
  std::copy(lens.k.begin(), lens.k.end(), numbers.begin() + 2);
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw InputError(fmt::format("{}: {}: got the coefficient {}, expected finite numbers", where,
                                   lens.model, number));
    }
  }
}

namespace {

constexpr int kDirections = 512;

// What lies in the file, by rays.
class SeenRegion {
 public:
  SeenRegion(const LensProjection& taken, int width, int height)
      : taken_(taken), size_(width, height) {}

  // The last ray in `direction`, of length 1, before one that is not in the file or no farther out
  // than those before it.
  glm::dvec2 border(const glm::dvec2& direction, double farthest) const {
    constexpr int kSteps = 128, kHalvings = 30;
    double inside = 0, outside = farthest;
    double out = 0;  // of the ray at `inside`, in the picture
    for (int step = 1; step <= kSteps; ++step) {
      const double reach = farthest * step / kSteps;
      const double next = distance(direction * reach);
      if (!(next > out) || !holds(direction * reach)) {
        outside = reach;
        break;
      }
      if (step == kSteps) return direction * farthest;
      inside = reach;
      out = next;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      // A little nearer to the axis: does it get farther out?
      const bool rises =
          distance(direction * middle) > distance(direction * (middle * (1 - kNearer)));
      (rises && holds(direction * middle) ? inside : outside) = middle;
    }
    return direction * inside;
  }

 private:
  static constexpr double kNearer = 1e-6;

  double distance(const glm::dvec2& at) const { return glm::length(distorted(taken_.lens, at)); }
  bool holds(const glm::dvec2& at) const {
    const glm::dvec2 px = taken_.centre_px + taken_.focal_px * distorted(taken_.lens, at);
    return px.x >= 0 && px.y >= 0 && px.x <= size_.x && px.y <= size_.y;
  }

  const LensProjection& taken_;
  glm::dvec2 size_;
};

// Half sides of the largest box around 0 that holds none of `border` and is no larger than `most`.
glm::dvec2 largest_box(std::vector<glm::dvec2> border, double most) {
  for (glm::dvec2& at : border) at = glm::abs(at);
  std::sort(border.begin(), border.end(),
            [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; });
  border.push_back({most, most});
  glm::dvec2 best(0.0);
  double height = most;  // of a box as wide as border[i]
  for (const glm::dvec2& at : border) {
    const glm::dvec2 box(std::min(at.x, most), height);
    if (box.x * box.y > best.x * best.y) best = box;
    if (at.x < most) height = std::min(height, at.y);
  }
  return best;
}

// As many px as `px` holds, even where `like` is.
int whole_px(double px, int like) {
  constexpr double kRounding = 1e-6;
  return like + 2 * static_cast<int>(std::floor(0.5 * (px + kRounding - like)));
}

// Of the file, what lies in a picture of `size_px`.
double area_px(const LensProjection& taken, const glm::ivec2& size_px) {
  constexpr int kPointsASide = 64;
  const glm::dvec2 half = 0.5 * glm::dvec2(size_px) / taken.focal_px;
  const glm::dvec2 corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  std::vector<glm::dvec2> outline;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < kPointsASide; ++i) {
      const glm::dvec2 at =
          glm::mix(corners[side], corners[(side + 1) % 4], static_cast<double>(i) / kPointsASide);
      outline.push_back(taken.focal_px * distorted(taken.lens, half * at));
    }
  }
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

}  // namespace

PinholePicture pinhole_picture(const LensProjection& taken, int width, int height,
                               const std::string& where) {
  check_lens(taken.lens, where);
  const double most = std::tan(glm::radians(0.5 * kWidestFieldDegrees));
  const SeenRegion region(taken, width, height);
  std::vector<glm::dvec2> border;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * M_PI * i / kDirections;
    border.push_back(region.border({std::cos(angle), std::sin(angle)}, std::sqrt(2.0) * most));
  }
  const glm::dvec2 sides = 2.0 * taken.focal_px * largest_box(std::move(border), most);
  constexpr double kMostGrowth = 4;  // more px than that are none of the file's
  if (sides.x > kMostGrowth * width || sides.y > kMostGrowth * height) {
    throw InputError(fmt::format(
        "{}: the lens {} makes {:.0f}x{:.0f} px of {}x{}, expected at most {} times the sides",
        where, taken.lens.model, sides.x, sides.y, width, height, kMostGrowth));
  }
  PinholePicture picture;
  picture.size_px = {whole_px(sides.x, width), whole_px(sides.y, height)};
  if (picture.size_px.x < 1 || picture.size_px.y < 1) {
    throw InputError(fmt::format(
        "{}: the lens {} leaves no pixel of {}x{}, expected rays that end farther out the farther "
        "they are from the axis",
        where, taken.lens.model, width, height));
  }
  picture.seen = std::min(1.0, area_px(taken, picture.size_px) / (1.0 * width * height));
  return picture;
}

namespace {

// Of the four pixels around a place `t` behind the second, from 0 to 1 (Catmull and Rom): as sharp
// as the photograph, where linear weights would blur it.
std::array<float, 4> weights_at(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5F * (2 * t2 - t - t3), 0.5F * (2 - 5 * t2 + 3 * t3), 0.5F * (t + 4 * t2 - 3 * t3),
          0.5F * (t3 - t2)};
}

// at: px, 0 in the middle of the first; beyond the border the border's.
glm::vec4 between_pixels(const RgbaImage& image, const glm::dvec2& at) {
  const glm::ivec2 last(image.width - 1, image.height - 1);
  const glm::dvec2 inside(std::min(std::max(0.0, at.x), 1.0 * last.x),
                          std::min(std::max(0.0, at.y), 1.0 * last.y));
  const glm::ivec2 first(inside);
  const glm::vec2 part(inside - glm::dvec2(first));
  const std::array<float, 4> across = weights_at(part.x), down = weights_at(part.y);
  glm::vec4 sum(0);
  for (int j = 0; j < 4; ++j) {
    const int y = std::clamp(first.y + j - 1, 0, last.y);
    glm::vec4 row(0);
    for (int i = 0; i < 4; ++i) {
      row +=
          across[static_cast<std::size_t>(i)] * image.at(std::clamp(first.x + i - 1, 0, last.x), y);
    }
    sum += down[static_cast<std::size_t>(j)] * row;
  }
  return glm::clamp(sum, 0.0F, 1.0F);
}

}  // namespace

RgbaImage undistorted(const RgbaImage& image, const LensProjection& taken,
                      const glm::ivec2& size_px) {
  RgbaImage out(size_px.x, size_px.y);
  for (int y = 0; y < size_px.y; ++y) {
    for (int x = 0; x < size_px.x; ++x) {
      const glm::dvec2 ray = (glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(size_px)) / taken.focal_px;
      const glm::dvec2 px = taken.centre_px + taken.focal_px * distorted(taken.lens, ray);
      out.at(x, y) = between_pixels(image, px - 0.5);
    }
  }
  return out;
}

}  // namespace sgs

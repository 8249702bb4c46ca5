// Growth of plants.h.
#include "testbench/builtin/plants.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "testbench/builtin/random.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/terrain.h"

namespace sgs {
namespace {

bool is_free(double x, double z) {
  const bool in_pond = std::hypot(x - kPondX, z - kPondZ) < kPondRadius + 1.6;
  const bool at_house = std::hypot(x + 6.0, z - 9.0) < 6.5,
             at_tower = std::hypot(x - 9, z - 16) < 5;
  const bool before_tower = z > 0 && z < 16 && std::abs(x - 0.56 * z) < 3.5;
  // Nor where the cameras stand.
  return !in_pond && !at_house && !at_tower && !before_tower && distance_from_path(x, z) > 2.0 &&
         std::hypot(x, z + 3.0) > 8.5;
}

// A flat leaf of `size` whose normal is near `out`.
void orient_leaf(const glm::dvec3& out, double size, Random& random, Surfel& surfel) {
  const glm::dvec3 normal = glm::normalize(out + 0.7 * random.direction());
  const glm::dvec3 along = glm::normalize(glm::cross(normal, random.direction()));
  surfel.axes = glm::dmat3(along, glm::cross(normal, along), normal);
  surfel.sigmas = glm::dvec3(1.0, 0.6, 0.12) * (size * random.uniform(0.6, 1.3));
}

ScenePart crown_part(const LeafTree& tree, double share) {
  double total = 0;
  for (const Ball& ball : tree.crown) total += ball.radius * ball.radius;
  return {share, [tree, total](const PartSample& sample, Random& random) {
            double pick = random.uniform(0.0, total);
            const Ball* ball = &tree.crown.front();
            for (const Ball& each : tree.crown) {
              ball = &each;
              pick -= each.radius * each.radius;
              if (pick <= 0) break;
            }
            const glm::dvec3 out = random.direction();
            const double depth = 1.0 - 0.45 * std::pow(random.uniform(), 2.0);
            Surfel surfel;
            surfel.position = ball->centre + out * (ball->radius * depth);
            // As many leaves as there are must cover the crown two to three times.
            const double area = 4.0 * M_PI * total;
            orient_leaf(out, 0.62 * std::sqrt(area / static_cast<double>(sample.count)), random,
                        surfel);
            surfel.shading_normal = glm::normalize(out + 0.5 * kUp);
            surfel.opacity = random.uniform(0.45, 0.99);
            const double low = (surfel.position.y - tree.root.y) / tree.height + 1.0;
            surfel.sky_visibility =
                std::clamp((1.05 - 0.75 * low) * (2.2 * depth - 1.2), 0.15, 1.0);
            const double tint = fractal_noise(surfel.position * 1.7, 2);
            surfel.material.albedo =
                tree.leaf_colour * ((0.55 + 0.9 * tint) * (0.5 + 0.5 * surfel.sky_visibility));
            surfel.material.reflectance = glm::dvec3(0.08);
            return surfel;
          }};
}

ScenePart needle_part(const Conifer& tree, double share) {
  return {share, [tree](const PartSample& sample, Random& random) {
            // Area of a cone falls linearly towards the tip; its skirts make seven tiers.
            const double t = 1.0 - std::sqrt(1.0 - random.uniform());
            const double tier = 7.0 * t - std::floor(7.0 * t);
            const double reach = tree.radius * (1.04 - t) * (1.0 - 0.45 * tier) *
                                 (1.0 - 0.35 * std::pow(random.uniform(), 2.0));
            const double angle = random.uniform(0.0, 2.0 * M_PI);
            const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
            Surfel surfel;
            surfel.position = tree.root + kUp * (tree.height * (0.10 + 0.90 * t)) + out * reach;
            const double area = M_PI * tree.radius * std::hypot(tree.radius, tree.height);
            const double size = 0.75 * std::sqrt(area / static_cast<double>(sample.count));
            const glm::dvec3 along = glm::normalize(out - 0.45 * kUp + 0.35 * random.direction());
            const glm::dvec3 across =
                glm::normalize(glm::cross(along, kUp + 0.3 * random.direction()));
            surfel.axes = glm::dmat3(along, across, glm::cross(along, across));
            surfel.sigmas = glm::dvec3(1.25, 0.5, 0.1) * (size * random.uniform(0.6, 1.3));
            surfel.shading_normal = glm::normalize(out + 0.6 * kUp);
            surfel.opacity = random.uniform(0.5, 0.99);
            const double exposed = reach / (tree.radius * (1.04 - t));
            surfel.sky_visibility = 0.2 + 0.8 * exposed * (0.5 + 0.5 * t);
            const double tint = 0.6 + 0.8 * fractal_noise(surfel.position * 1.1, 2);
            surfel.material.albedo = glm::dvec3(0.08, 0.21, 0.10) * (tint * (0.35 + exposed));
            surfel.material.reflectance = glm::dvec3(0.06);
            return surfel;
          }};
}

ScenePart trunk_part(const glm::dvec3& root, double height, double radius, double share) {
  const auto profile = [=](double v) {
    return glm::dvec2(radius * (1.0 - 0.5 * v + 0.5 * std::exp(-12.0 * v)), height * v - 0.1);
  };
  return patch_part(share, lathe_map(root, profile), [](const SurfacePoint& p) {
    const double bark = fractal_noise(p.position * glm::dvec3(9.0, 2.0, 9.0), 3);
    return Material{glm::dvec3(0.30, 0.22, 0.15) * (0.4 + 1.1 * bark), {}, {}};
  });
}

}  // namespace

LeafTree leaf_tree(const glm::dvec3& root, Random& random) {
  LeafTree tree{root, random.uniform(4.2, 6.8), {}, {}};
  const double autumn = random.uniform() < 0.2 ? 1.0 : random.uniform(0.0, 0.25);
  tree.leaf_colour = glm::mix(glm::dvec3(0.24, 0.46, 0.10), glm::dvec3(0.85, 0.42, 0.07), autumn);
  const glm::dvec3 middle = root + kUp * (0.66 * tree.height);
  tree.crown.push_back({middle, 0.27 * tree.height});
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 away = random.direction() * glm::dvec3(0.30, 0.20, 0.30) * tree.height;
    tree.crown.push_back({middle + away, random.uniform(0.13, 0.21) * tree.height});
  }
  return tree;
}

Plants planted() {
  Random random(4711);
  Plants plants;
  const auto place = [&random](double least, double most) {
    while (true) {
      const double radius = std::sqrt(random.uniform(least * least, most * most));
      const double angle = random.uniform(0.0, 2.0 * M_PI);
      const double x = radius * std::cos(angle), z = radius * std::sin(angle);
      if (is_free(x, z)) return ground_point(x, z);
    }
  };
  for (int i = 0; i < 16; ++i) plants.leaf_trees.push_back(leaf_tree(place(9, 26), random));
  for (int i = 0; i < 46; ++i) {
    const double height = random.uniform(5.0, 10.0);
    plants.conifers.push_back({place(17, 75), height, height * random.uniform(0.2, 0.26)});
  }
  return plants;
}

std::vector<ScenePart> plant_parts(const Plants& plants, double share) {
  // Near trees deserve more Gaussians than far ones.
  const auto weight = [](const glm::dvec3& root) {
    return 1.0 / (8.0 + std::hypot(root.x, root.z));
  };
  double total = 0;
  for (const LeafTree& tree : plants.leaf_trees) total += 1.6 * weight(tree.root);
  for (const Conifer& tree : plants.conifers) total += weight(tree.root);
  std::vector<ScenePart> parts;
  for (const LeafTree& tree : plants.leaf_trees) {
    const double part = 1.6 * share * weight(tree.root) / total;
    parts.push_back(crown_part(tree, 0.92 * part));
    parts.push_back(trunk_part(tree.root, 0.62 * tree.height, 0.045 * tree.height, 0.08 * part));
  }
  for (const Conifer& tree : plants.conifers) {
    const double part = share * weight(tree.root) / total;
    parts.push_back(needle_part(tree, 0.96 * part));
    parts.push_back(trunk_part(tree.root, 0.5 * tree.height, 0.03 * tree.height, 0.04 * part));
  }
  return parts;
}

std::vector<Capsule> plant_occluders(const Plants& plants) {
  std::vector<Capsule> capsules;
  for (const LeafTree& tree : plants.leaf_trees) {
    const Ball& middle = tree.crown.front();
    capsules.push_back({middle.centre, middle.centre, 0.95 * middle.radius});
    for (std::size_t i = 1; i < tree.crown.size(); i += 2) {
      capsules.push_back({tree.crown[i].centre, tree.crown[i].centre, 0.85 * tree.crown[i].radius});
    }
    capsules.push_back({tree.root, middle.centre, 0.03 * tree.height});
  }
  for (const Conifer& tree : plants.conifers) {
    const glm::dvec3 low = tree.root + kUp * (0.2 * tree.height);
    capsules.push_back({low, low + kUp * (0.25 * tree.height), 0.45 * tree.radius});
    capsules.push_back({low, low + kUp * (0.6 * tree.height), 0.2 * tree.radius});
  }
  return capsules;
}

}  // namespace sgs

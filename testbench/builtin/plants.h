// Trees of the built-in scenes, those of `outdoor` above all.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/random.h"
#include "testbench/builtin/scene_builder.h"

namespace sgs {

struct Ball {
  glm::dvec3 centre{0.0};
  double radius = 1;
};

struct LeafTree {
  glm::dvec3 root{0.0};
  double height = 5;
  glm::dvec3 leaf_colour{0.2, 0.4, 0.1};
  std::vector<Ball> crown;
};

struct Conifer {
  glm::dvec3 root{0.0};
  double height = 7, radius = 1.6;
};

struct Plants {
  std::vector<LeafTree> leaf_trees;
  std::vector<Conifer> conifers;
};

// A tree on `root`, 4.2 to 6.8 units high.
LeafTree leaf_tree(const glm::dvec3& root, Random& random);

// Trees around the origin, none on the path, in the pond or where the buildings stand.
Plants planted();

std::vector<ScenePart> plant_parts(const Plants& plants, double share);
std::vector<Capsule> plant_occluders(const Plants& plants);

}  // namespace sgs

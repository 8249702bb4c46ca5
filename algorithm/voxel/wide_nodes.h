// Which descendants of a binary node become the up to eight children of a wide one: those with
// which all wide nodes of the tree together have the least inflated area, by dynamic programming
// (Ylitie, Karras and Laine 2017, section 4, without leaves of several primitives: chunks stay as
// they are). A node that is full costs what one with two children does: opening the largest child
// until there are eight leaves 4.5 children in a node, this 6.1.
#pragma once

#include <vector>

#include "algorithm/voxel/binary_tree.h"

namespace sgs {

// Fills node.cost_as from that of its children.
void note_costs(BinaryNode& node);

// Children of the wide node that stands for `node` and all below, in the order of the binary tree:
// `node` itself where it is a leaf. Needs the costs of all nodes below.
std::vector<const BinaryNode*> wide_children(const BinaryNode& node);

}  // namespace sgs

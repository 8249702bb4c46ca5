// Exact order against the reference renderer, bit for bit.
#pragma once

#include <string>

#include "algorithm/render/exact_renderer.h"
#include "algorithm/scene/camera.h"

namespace sgs::test {

// Empty where picture, transmittance and contributors of both are the same to the bit; else where
// they differ first.
std::string first_difference(const RenderResult& got, const RenderResult& expected);

// The same of exact order and the reference. cloud: in storage order.
std::string difference_from_reference(const View<float>& view, const ActivatedCloud& cloud,
                                      const ChunkTree& tree, const ExactOrderConfig& config);

// Random hard scenes under random configurations; fails at the first that differs.
void fuzz_exact_order(unsigned first_seed, unsigned scenes);

// All views of a scene of ../shared, as shipped and with small groups, chunks, buffer and queue;
// skipped where it is missing.
void check_exact_on_shared(const std::string& name);

}  // namespace sgs::test

// Codebooks that are there, and who uses which of their entries.
#include <catch2/catch.hpp>

#include "algorithm/splat/activate.h"
#include "algorithm/vq/quantise.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/vq/small_config.h"

namespace sgs {
namespace {

struct Case {
  ActivatedCloud cloud = activate(test::random_cloud(1, 3000, 2, {0, 0, 0}, 3, 0.01F, 1));
  std::vector<float> weights = std::vector<float>(cloud.size(), 1.0F);
  std::vector<float> pixel_sizes = std::vector<float>(cloud.size(), 0.01F);
  QuantisedCloud quantised;

  Case() { quantised = quantise(cloud, weights, pixel_sizes, test::small_config()); }
};

TEST_CASE("assign: what quantise() found is found again, and no entry moves") {
  const Case given;
  QuantisedCloud again = given.quantised;
  for (auto& indices : again.indices) std::fill(indices.begin(), indices.end(), 0U);
  std::fill(again.opacities.begin(), again.opacities.end(), std::uint8_t{7});
  assign_entries(given.cloud, given.weights, given.pixel_sizes, again);
  CHECK(again.codebooks == given.quantised.codebooks);
  CHECK(again.opacities == given.quantised.opacities);
  for (const Codebook codebook : {Codebook::kRotation, Codebook::kDc, Codebook::kSh}) {
    const auto id = static_cast<std::size_t>(codebook);
    CHECK(again.indices[id] == given.quantised.indices[id]);
  }
  // Entries of scales are rounded on their way through logarithms: ties may fall otherwise.
  std::size_t others = 0;
  for (std::size_t i = 0; i < given.cloud.size(); ++i) {
    others += again.indices[0][i] != given.quantised.indices[0][i] ? 1 : 0;
  }
  CHECK(others <= 3);
}

TEST_CASE("assign: an entry that nobody uses goes where most is wrong, by weight") {
  Case given;
  struct Row {
    Codebook codebook;
    std::size_t words, gaussian;
  };
  for (const Row& row :
       {Row{Codebook::kDc, 3, 17}, {Codebook::kSh, 24, 18}, {Codebook::kScale, 3, 19}}) {
    const auto id = static_cast<std::size_t>(row.codebook);
    QuantisedCloud quantised = given.quantised;
    std::vector<float> weights = given.weights;
    weights[row.gaussian] = 1e9F;
    // The last entry as the first: of equal distances the first wins.
    std::vector<float>& words = quantised.codebooks[id];
    std::copy_n(words.begin(), row.words, words.end() - static_cast<std::ptrdiff_t>(row.words));
    const std::vector<float> before = words;
    assign_entries(given.cloud, weights, given.pixel_sizes, quantised);
    const std::size_t last = words.size() / row.words - 1;
    INFO("codebook " << id);
    CHECK(quantised.indices[id][row.gaussian] == last);
    CHECK(std::equal(words.begin(), words.end() - static_cast<std::ptrdiff_t>(row.words),
                     before.begin()));
    if (row.codebook != Codebook::kDc) continue;
    for (int k = 0; k < 3; ++k) {
      CHECK(words[3 * last + static_cast<std::size_t>(k)] == given.cloud.sh(row.gaussian)[0][k]);
    }
  }
}

}  // namespace
}  // namespace sgs

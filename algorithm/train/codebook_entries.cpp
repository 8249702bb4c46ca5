#include "algorithm/train/codebook_entries.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "algorithm/splat/activate.h"

namespace sgs {
namespace {

float ratio_of(float log_ratio) {
  return static_cast<float>(std::min(std::exp(static_cast<double>(log_ratio)), 1.0));
}

// Adds what row `from` of a decoded Gaussian's gradient says of its entry.
void add(Codebook codebook, const GaussianCloud& by, std::size_t from, GaussianCloud& sums,
         std::size_t to) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(by.sh_degree));
  switch (codebook) {
    case Codebook::kScale:
      sums.log_scales[to].y += by.log_scales[from].y;
      sums.log_scales[to].z += by.log_scales[from].z;
      return;
    case Codebook::kRotation:
      for (std::size_t k = 0; k < 4; ++k) sums.quats[to][k] += by.quats[from][k];
      return;
    case Codebook::kDc:
      sums.sh_coeffs[to] += by.sh_coeffs[from * coeffs];
      return;
    default:
      for (std::size_t k = 1; k < coeffs; ++k) {
        sums.sh_coeffs[to * coeffs + k] += by.sh_coeffs[from * coeffs + k];
      }
  }
}

int degree_of(Codebook codebook, int sh_degree) {
  return codebook == Codebook::kSh ? sh_degree : 0;
}

}  // namespace

CodebookEntries::CodebookEntries(const QuantisedCloud& quantised, int sh_degree) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    const std::vector<float>& words = quantised.codebooks[id];
    const std::size_t each = codebook_words(codebook, sh_degree);
    entries_[id].resize(words.empty() ? 0 : words.size() / each, degree_of(codebook, sh_degree));
    for (std::size_t e = 0; e < count(id); ++e) read(id, e, &words[e * each]);
    adam_.emplace_back(entries_[id]);
  }
}

void CodebookEntries::read(std::size_t id, std::size_t e, const float* words) {
  GaussianCloud& cloud = entries_[id];
  switch (static_cast<Codebook>(id)) {
    case Codebook::kScale:
      cloud.log_scales[e] = {0, log_scale_of(words[1]), log_scale_of(words[2])};
      return;
    case Codebook::kRotation:
      std::copy_n(words, 4, cloud.quats[e].begin());
      return;
    case Codebook::kDc:
      cloud.sh_coeffs[e] = {words[0], words[1], words[2]};
      return;
    default:
      const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
      std::copy_n(words, 3 * (coeffs - 1), &cloud.sh_coeffs[e * coeffs + 1].x);
  }
}

void CodebookEntries::write(std::size_t id, std::size_t e, float* words) const {
  const GaussianCloud& cloud = entries_[id];
  switch (static_cast<Codebook>(id)) {
    case Codebook::kScale: {
      words[0] = 1;
      words[1] = ratio_of(cloud.log_scales[e].y);
      words[2] = std::min(words[1], ratio_of(cloud.log_scales[e].z));
      return;
    }
    case Codebook::kRotation: {
      double squares = 0;
      for (const float part : cloud.quats[e]) squares += static_cast<double>(part) * part;
      for (std::size_t k = 0; k < 4; ++k) {
        words[k] = static_cast<float>(cloud.quats[e][k] / std::sqrt(squares));
      }
      return;
    }
    case Codebook::kDc:
      std::copy_n(&cloud.sh_coeffs[e].x, 3, words);
      return;
    default:
      const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
      std::copy_n(&cloud.sh_coeffs[e * coeffs + 1].x, 3 * (coeffs - 1), words);
  }
}

void CodebookEntries::step(const CloudGradient& gradient, const LearningRates& rates,
                           QuantisedCloud& quantised) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (count(id) == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> rank_of(count(id), kUnused);
    for (const std::uint32_t i : gradient.indices) rank_of[quantised.indices[id][i]] = 0;
    CloudGradient sums;
    for (std::uint32_t e = 0; e < rank_of.size(); ++e) {
      if (rank_of[e] == kUnused) continue;
      rank_of[e] = static_cast<std::uint32_t>(sums.indices.size());
      sums.indices.push_back(e);
    }
    sums.resize(sums.indices.size(), entries_[id].sh_degree);
    for (std::size_t r = 0; r < gradient.size(); ++r) {
      const std::uint32_t e = quantised.indices[id][gradient.indices[r]];
      add(codebook, gradient.parameters, r, sums.parameters, rank_of[e]);
    }
    adam_[id].step(sums, rates, entries_[id]);
    const std::size_t each = quantised.codebooks[id].size() / count(id);
    for (const std::uint32_t e : sums.indices) write(id, e, &quantised.codebooks[id][e * each]);
  }
}

void CodebookEntries::replace(const std::array<std::vector<float>, kCodebookCount>& before,
                              const QuantisedCloud& quantised) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (count(id) == 0) continue;
    const std::vector<float>& words = quantised.codebooks[id];
    const std::size_t each = words.size() / count(id);
    std::vector<std::uint32_t> from(count(id));
    std::iota(from.begin(), from.end(), 0U);
    for (std::size_t e = 0; e < count(id); ++e) {
      const float* entry = &words[e * each];
      if (std::equal(entry, entry + each, &before[id][e * each])) continue;
      read(id, e, entry);
      from[e] = Adam::kNew;
    }
    adam_[id].rearrange(from);
  }
}

CodebookEntries::State CodebookEntries::state() const {
  State out;
  out.entries = entries_;
  for (std::size_t id = 0; id < kCodebookCount; ++id) out.moments[id] = adam_[id].moments();
  return out;
}

void CodebookEntries::restore(State state) {
  entries_ = std::move(state.entries);
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    adam_[id].restore(std::move(state.moments[id]));
  }
}

}  // namespace sgs

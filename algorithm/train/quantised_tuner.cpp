// Steps, alignment and reassignment of quantised scenes.
#include "algorithm/train/quantised_tuner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/saved_bytes.h"
#include "algorithm/vq/quantise.h"
#include "algorithm/vq/vq_points.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, QuantisedCloud& quantised) {
  archive(quantised.codebooks, quantised.indices, quantised.opacities);
}
template <class Archive>
void serialize(Archive& archive, CodebookEntries::State& state) {
  archive(state.entries, state.moments);
}
template <class Archive>
void serialize(Archive& archive, QuantisedTuner::State& state) {
  archive(state.next_step, state.own, state.moments, state.entries, state.quantised,
          state.reassigned);
}

namespace {

using Quaternion = std::array<float, 4>;  // w, x, y, z

// The quaternion nearest to an entry among those that name the same ellipsoid with its axes in this
// order: q, q i, q j and q k, either sign.
Quaternion nearest_name(const Quaternion& q, const float* entry) {
  const Quaternion names[4] = {{q[0], q[1], q[2], q[3]},
                               {-q[1], q[0], q[3], -q[2]},
                               {-q[2], -q[3], q[0], q[1]},
                               {-q[3], q[2], -q[1], q[0]}};
  const auto along = [&](const Quaternion& name) {
    return name[0] * entry[0] + name[1] * entry[1] + name[2] * entry[2] + name[3] * entry[3];
  };
  Quaternion best = names[0];
  for (const Quaternion& name : names) {
    if (std::abs(along(name)) > std::abs(along(best))) best = name;
  }
  if (along(best) < 0) {
    for (float& part : best) part = -part;
  }
  return best;
}

std::vector<std::uint32_t> all_of(std::size_t count) {
  std::vector<std::uint32_t> out(count);
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

GaussianCloud file_form(const GaussianCloud& own) {
  GaussianCloud out = own;
  for (glm::vec3& logs : out.log_scales) logs = {logs.x, logs.x + logs.y, logs.x + logs.z};
  return out;
}

}  // namespace

QuantisedTuner::QuantisedTuner(const QuantisedTuningConfig& config, const Photographs& photographs,
                               DrawingOrder order, Weighing weighing, const ActivatedCloud& given,
                               QuantisedCloud quantised)
    : config_(config),
      photographs_(photographs),
      order_(std::move(order)),
      weighing_(std::move(weighing)),
      own_(deactivate(given)),
      file_(own_),
      exact_(given),
      quantised_(std::move(quantised)),
      entries_(quantised_, given.sh_degree),
      adam_(own_),
      view_order_(config.seed) {
  const std::vector<std::uint32_t> all = all_of(file_.size());
  align(all);
  refresh(all);
}

QuantisedTuner::QuantisedTuner(const QuantisedTuningConfig& config, const Photographs& photographs,
                               DrawingOrder order, Weighing weighing, State state)
    : config_(config),
      photographs_(photographs),
      order_(std::move(order)),
      weighing_(std::move(weighing)),
      next_step_(state.next_step),
      own_(std::move(state.own)),
      file_(file_form(own_)),
      exact_(activate(file_)),
      quantised_(std::move(state.quantised)),
      entries_(quantised_, own_.sh_degree),
      adam_(own_),
      view_order_(config.seed),
      reassigned_(state.reassigned) {
  adam_.restore(std::move(state.moments));
  entries_.restore(std::move(state.entries));
}

std::string QuantisedTuner::saved() const {
  return saved_bytes(
      State{next_step_, own_, adam_.moments(), entries_.state(), quantised_, reassigned_});
}

QuantisedTuner::State QuantisedTuner::restored(const std::string& saved) {
  State state;
  restore_bytes(saved, state);
  return state;
}

double QuantisedTuner::reassigned() const {
  return static_cast<double>(reassigned_) /
         static_cast<double>(std::max<std::size_t>(1, gaussians()));
}

// Puts the axes of these Gaussians into the order of their scales and names their rotations as near
// to their entries as can be, as straight through needs it; whoever is renamed has no moments.
void QuantisedTuner::align(const std::vector<std::uint32_t>& indices) {
  constexpr auto kRotation = static_cast<std::size_t>(Codebook::kRotation);
  std::vector<std::uint32_t> from = all_of(own_.size());
  for (const std::uint32_t i : indices) {
    const Gaussian<float>& g = exact_.gaussians[i];
    const CanonicalShape shape = canonical_shape(g.scale, g.quat);
    const Quaternion quat = nearest_name(
        shape.quat, &quantised_.codebooks[kRotation][4 * quantised_.indices[kRotation][i]]);
    double along = 0;
    for (std::size_t k = 0; k < 4; ++k) along += static_cast<double>(quat[k]) * g.quat[k];
    constexpr double kSame = 1 - 1e-6;
    if (next_step_ > 0 && shape.scale == g.scale && along > kSame) continue;
    const float largest = log_scale_of(shape.scale.x);
    own_.log_scales[i] = {largest, log_scale_of(shape.scale.y) - largest,
                          log_scale_of(shape.scale.z) - largest};
    own_.quats[i] = quat;
    from[i] = Adam::kNew;
  }
  adam_.rearrange(from);
}

// After own_ was changed at these.
void QuantisedTuner::refresh(const std::vector<std::uint32_t>& indices) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(own_.sh_degree));
  for (const std::uint32_t i : indices) {
    glm::vec3& logs = own_.log_scales[i];
    logs.y = std::min(logs.y, 0.0F);  // the largest stays the largest
    logs.z = std::min(logs.z, 0.0F);
    file_.log_scales[i] = {logs.x, logs.x + logs.y, logs.x + logs.z};
    file_.quats[i] = own_.quats[i];
    file_.opacity_logits[i] = own_.opacity_logits[i];
    std::copy_n(&own_.sh_coeffs[i * coeffs], coeffs, &file_.sh_coeffs[i * coeffs]);
  }
  reactivate(file_, indices, exact_);
  for (const std::uint32_t i : indices) {
    quantised_.opacities[i] = opacity_code(exact_.gaussians[i].opacity);
  }
}

// The largest scale is a factor of all three.
void QuantisedTuner::to_own_parameters(CloudGradient& gradient) const {
  for (glm::vec3& by : gradient.parameters.log_scales) by.x += by.y + by.z;
}

void QuantisedTuner::reassign() {
  const auto words = quantised_.codebooks;
  const auto indices = quantised_.indices;
  assign_entries(exact_, weighing_.weights, weighing_.pixel_sizes, quantised_);
  entries_.replace(words, quantised_);
  reassigned_ = 0;
  for (std::size_t i = 0; i < gaussians(); ++i) {
    bool moved = false;
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      moved |= !indices[id].empty() && indices[id][i] != quantised_.indices[id][i];
    }
    reassigned_ += moved ? 1 : 0;
  }
  const std::vector<std::uint32_t> all = all_of(gaussians());
  align(all);
  refresh(all);
}

// The parameters of what is drawn, by which derivatives are taken; colours are no function of any.
// An opacity is taken as it was before it was rounded.
GaussianCloud QuantisedTuner::parameters_of(const ActivatedCloud& drawn) const {
  GaussianCloud out;
  out.sh_degree = drawn.sh_degree;
  out.means = file_.means;
  out.log_scales = file_.log_scales;
  out.opacity_logits = file_.opacity_logits;
  out.quats.reserve(drawn.size());
  for (const Gaussian<float>& g : drawn.gaussians) out.quats.push_back(g.quat);
  return out;
}

FittingStep QuantisedTuner::step() {
  const std::size_t at = view_order_.at(next_step_, photographs_.size());
  const auto view = make_view<float>(photographs_.camera(at));
  const ActivatedCloud drawn = encode_quantised(exact_, quantised_, config_.encoding).decoded;
  const GaussianCloud parameters = parameters_of(drawn);
  const GroupSequences sequences = order_.sequences(at, view, drawn);
  const double loss = compare_with(
      photographs_.before(at, order_.background), photographs_.counts(at), view, parameters, drawn,
      sequences, order_.background, order_.precision, config_.comparison, gradient_);
  check_finite(next_step_, loss, gradient_);
  const LearningRates rates = config_.rates_at(next_step_);
  entries_.step(gradient_, rates, quantised_);
  to_own_parameters(gradient_);
  const auto beyond = adam_.step(gradient_, rates, own_);
  refresh(gradient_.indices);
  check_limits(next_step_, beyond);
  const FittingStep done{next_step_++, at, loss};
  if (next_step_ % config_.reassign_every == 0 && next_step_ < config_.steps) reassign();
  return done;
}

StoredScene QuantisedTuner::stored(const StorageConfig& storage) const {
  return store_quantised(exact_, quantised_, storage);
}

}  // namespace sgs

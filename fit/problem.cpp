// Residual sums chained from coefficients to free parameters.
#include "fit/problem.h"

#include <ceres/jet.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "brdf/coefficients.h"
#include "brdf/models.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void accumulate_gram(const fit::GramJob&, fit::Gram&))
BRDFIT_DECLARE_SIMD(double evaluate_cost(const fit::GramJob&))

}  // namespace brdfit::simd

namespace brdfit::fit {
namespace {

// Values and derivatives of one channel's coefficients.
struct Coefficients {
  std::vector<double> value;
  Eigen::MatrixXd jacobian;  // coefficients x product form
};

template <int N>
Coefficients collect(std::initializer_list<ceres::Jet<double, N>> jets) {
  Coefficients result;
  result.jacobian.resize(static_cast<Eigen::Index>(jets.size()), N);
  Eigen::Index row = 0;
  for (const auto& jet : jets) {
    result.value.push_back(jet.a);
    result.jacobian.row(row++) = jet.v.transpose();
  }
  return result;
}

template <int N>
std::array<ceres::Jet<double, N>, N> variables(std::span<const double> q) {
  std::array<ceres::Jet<double, N>, N> jets;
  for (int k = 0; k < N; ++k) jets[static_cast<std::size_t>(k)] = {q[static_cast<std::size_t>(k)], k};
  return jets;
}

// The coefficients of all channels of a model, in the order of fit/gram.h.
std::array<Coefficients, 3> differentiate(const Material& material, std::span<const double> q) {
  std::array<Coefficients, 3> result;
  switch (material.model()) {
    case Model::kLambertGgx: {
      const auto jets = variables<kLambertGgxProductSize>(q);
      const auto k = lambert_ggx_coefficients(jets.data());
      for (std::size_t c = 0; c < 3; ++c) {
        result[c] = collect<kLambertGgxProductSize>({k.shape.alpha, k.colour[c].rho, k.colour[c].f0});
      }
      break;
    }
    case Model::kBurley: {
      const auto jets = variables<kBurleyProductSize>(q);
      const auto k = burley_coefficients(jets.data(), static_cast<int>(material.effects().bits()));
      for (std::size_t c = 0; c < 3; ++c) {
        result[c] = collect<kBurleyProductSize>({k.shape.roughness, k.shape.subsurface, k.shape.alpha_x,
                                                 k.shape.clearcoat_alpha, k.colour[c].rho, k.colour[c].sheen,
                                                 k.colour[c].f0, k.colour[c].clearcoat});
      }
      break;
    }
    case Model::kCallisto: {
      const auto jets = variables<kCallistoProductSize>(q);
      const auto k = callisto_coefficients(jets.data());
      for (std::size_t c = 0; c < 3; ++c) {
        result[c] = collect<kCallistoProductSize>(
            {k.shape.alpha_1, k.shape.alpha_2, k.shape.opacity, k.shape.fresnel_exponent,
             k.shape.fresnel_tangent_exponent, k.shape.retro_exponent, k.shape.retro_tangent_exponent,
             k.shape.specular_falloff, k.shape.terminator_length, k.colour[c].rho, k.colour[c].f0,
             k.colour[c].fresnel, k.colour[c].retro, k.colour[c].terminator});
      }
      break;
    }
  }
  return result;
}

// How many of a channel's coefficients belong to the shape.
std::size_t shape_count(Model model) {
  switch (model) {
    case Model::kLambertGgx:
      return 1;
    case Model::kBurley:
      return 4;
    case Model::kCallisto:
      return 9;
  }
  return 0;
}

// Values as vector code takes them; Burley's kernel has alpha twice.
void fill(simd::Coefficients& to, Model model, const std::array<Coefficients, 3>& from) {
  const std::size_t shape = shape_count(model);
  const std::vector<double>& first = from[0].value;
  if (model == Model::kBurley) {
    std::ranges::copy(std::array{first[0], first[1], first[2], first[2], first[3]}, to.shape);
  } else {
    std::copy_n(first.begin(), shape, to.shape);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    std::copy(from[c].value.begin() + static_cast<std::ptrdiff_t>(shape), from[c].value.end(), to.colour[c]);
  }
}

std::array<Coefficients, 3> coefficients_at(const Parametrisation& parametrisation,
                                            std::span<const double> x) {
  return differentiate(parametrisation.start, parametrisation.product(x));
}

GramJob with(GramJob job, const std::array<Coefficients, 3>& channels) {
  fill(job.coefficients, static_cast<Model>(job.coefficients.model), channels);
  return job;
}

// Long enough for a thread to be worth its start.
constexpr std::size_t kChunk = 64 * simd::kBlock;

std::size_t chunk_count(const GramJob& job) {
  return (job.count + kChunk - 1) / kChunk;
}

// The k-th part of that size.
GramJob chunk_of(const GramJob& job, std::size_t k, std::size_t size = kChunk) {
  const std::size_t first = k * size;
  GramJob chunk = job;
  chunk.count = std::min(size, job.count - first);
  for (const double** column :
       {&chunk.geometry.cos_i, &chunk.geometry.cos_o, &chunk.geometry.sin_h, &chunk.geometry.cos_h,
        &chunk.geometry.cos_d, &chunk.geometry.one_minus_cos_h, &chunk.geometry.one_minus_cos_d,
        &chunk.geometry.log_cos_h, &chunk.geometry.log_cos_d, &chunk.geometry.log_one_minus_cos_h,
        &chunk.geometry.log_one_minus_cos_d, &chunk.sqrt_weight, &chunk.clipped_share, &chunk.target[0],
        &chunk.target[1], &chunk.target[2], &chunk.clipped_target[0], &chunk.clipped_target[1],
        &chunk.clipped_target[2]}) {
    *column += first;
  }
  if (chunk.single != nullptr) chunk.single += first;
  return chunk;
}

void add(Gram& to, const Gram& from) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < std::size(to.channel[c]); ++k) to.channel[c][k] += from.channel[c][k];
  }
  to.cost += from.cost;
}

// How one coefficient of a channel depends on one free number. A coefficient depends on few.
struct Link {
  Eigen::Index coefficient;
  Eigen::Index number;
  double slope;
};

// Coefficients by product form, product form by free numbers; the residual, last of both, stays itself.
std::vector<Link> links(const Parametrisation& parametrisation, const Eigen::MatrixXd& by_product) {
  std::vector<Link> result;
  result.reserve(static_cast<std::size_t>(by_product.size()) + 1);
  for (std::size_t entry = 0; entry < parametrisation.source.size(); ++entry) {
    if (parametrisation.source[entry] < 0) continue;
    for (Eigen::Index k = 0; k < by_product.rows(); ++k) {
      const double slope = parametrisation.factor[entry] * by_product(k, static_cast<Eigen::Index>(entry));
      if (slope != 0.0) result.push_back({k, parametrisation.source[entry], slope});
    }
  }
  result.push_back({by_product.rows(), static_cast<Eigen::Index>(parametrisation.size()), 1.0});
  return result;
}

using ChannelLinks = std::array<std::vector<Link>, 3>;

ChannelLinks channel_links(const Parametrisation& parametrisation,
                           const std::array<Coefficients, 3>& channels) {
  ChannelLinks result;
  for (std::size_t c = 0; c < 3; ++c) result[c] = links(parametrisation, channels[c].jacobian);
  return result;
}

// Sums over coefficients as sums over free numbers.
Eigen::MatrixXd chained(const Gram& sums, const ChannelLinks& chain, std::size_t parameters) {
  const auto side = static_cast<Eigen::Index>(parameters) + 1;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(side, side);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<Link>& all = chain[c];
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Link& a = all[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const Link& b = all[j];
        const auto [row, column] = std::minmax(a.coefficient, b.coefficient);
        const double product = a.slope * b.slope * sums.channel[c][row * kGramSide + column];
        total(a.number, b.number) += product;
        if (i != j) total(b.number, a.number) += product;
      }
    }
  }
  return total;
}

}  // namespace

Targets make_targets(const SampleSet& samples, Loss loss) {
  Targets targets;
  const LossShape shape = shape_of(loss);
  targets.robust_width = shape.robust_width;
  targets.clipped_width = shape.clipped_width;
  for (const double weight : samples.weight()) targets.sqrt_weight.push_back(std::sqrt(weight));
  for (int c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < samples.padded_size(); ++k) {
      targets.value[c].push_back(loss_target(loss, samples.f(c)[k], samples.cos_i()[k]));
      targets.clipped[c].push_back(loss_target(Loss::kSlice, samples.f(c)[k], samples.cos_i()[k]));
    }
  }
  // The slice measure ends at 80 deg in both angles, where measurements become extrapolation.
  const double lowest = std::cos(80.0 * std::numbers::pi / 180.0);
  for (std::size_t k = 0; k < samples.padded_size(); ++k) {
    const double h = samples.cos_h()[k];
    const double d = samples.cos_d()[k];
    const bool counts = h > lowest && d > lowest;
    targets.clipped_share.push_back(counts ? shape.clipped_share / std::sqrt(h * d) : 0.0);
  }
  return targets;
}

std::vector<float> single_columns(const GramJob& job) {
  std::vector<float> result;
  result.reserve(kSingleColumns * job.count);
  for (const double* column :
       {job.geometry.cos_i, job.geometry.cos_o, job.geometry.sin_h, job.geometry.cos_h, job.geometry.cos_d,
        job.geometry.one_minus_cos_h, job.geometry.one_minus_cos_d, job.geometry.log_cos_h,
        job.geometry.log_cos_d, job.geometry.log_one_minus_cos_h, job.geometry.log_one_minus_cos_d,
        job.sqrt_weight, job.clipped_share, job.target[0], job.target[1], job.target[2],
        job.clipped_target[0], job.clipped_target[1], job.clipped_target[2]}) {
    for (std::size_t k = 0; k < job.count; ++k) result.push_back(static_cast<float>(column[k]));
  }
  return result;
}

GramFunction gram_function(simd::Isa isa) {
  using namespace simd;
  return BRDFIT_PICK(isa, accumulate_gram);
}

CostFunction cost_function(simd::Isa isa) {
  using namespace simd;
  return BRDFIT_PICK(isa, evaluate_cost);
}

Eigen::MatrixXd coefficient_jacobian(const Material& options, std::span<const double> q, int channel) {
  return differentiate(options, q)[static_cast<std::size_t>(channel)].jacobian;
}

Problem::Problem(const Parametrisation& parametrisation, const SampleSet& samples, const Targets& targets,
                 Loss loss, Precision precision)
    : parametrisation_(parametrisation),
      samples_(samples),
      targets_(targets),
      loss_(loss),
      has_two_orders_(samples.has_two_orders()),
      gram_function_(gram_function(simd::best_isa())),
      cost_function_(cost_function(simd::best_isa())) {
  const bool has_code = loss == Loss::kLogRatio && targets.robust_width > 0.0 && targets.clipped_width > 0.0;
  if (precision == Precision::kSingle && has_code) single_ = single_columns(job());
}

GramJob Problem::job() const {
  const Material& material = parametrisation_.start;
  GramJob job;
  job.coefficients.model = static_cast<int>(material.model());
  job.coefficients.masking = static_cast<int>(material.options().masking);
  job.coefficients.burley_g = static_cast<int>(material.options().burley_g);
  job.coefficients.diffuse = static_cast<int>(material.options().diffuse);
  // Data are isotropic: the stretched lobe would only cost time.
  job.coefficients.effects = static_cast<int>(material.effects().without(Effect::kAnisotropic).bits());
  job.geometry = samples_.geometry();
  job.sqrt_weight = targets_.sqrt_weight.data();
  for (std::size_t c = 0; c < 3; ++c) {
    job.target[c] = targets_.value[c].data();
    job.clipped_target[c] = targets_.clipped[c].data();
  }
  job.count = samples_.padded_size();
  job.loss = static_cast<int>(loss_);
  job.mean_of_orders = has_two_orders_ && !is_reciprocal(material);
  job.robust_width = targets_.robust_width;
  job.clipped_width = targets_.clipped_width;
  job.clipped_share = targets_.clipped_share.data();
  if (!single_.empty()) {
    job.single = single_.data();
    job.single_stride = job.count;
  }
  return job;
}

// Chunks of a fixed size are summed apart and added in order, so that results do not depend on threads.
double Problem::cost(std::span<const double> x) const {
  const GramJob job = with(this->job(), coefficients_at(parametrisation_, x));
  std::vector<double> costs(chunk_count(job));
  tbb::parallel_for(std::size_t{0}, costs.size(),
                    [&](std::size_t k) { costs[k] = cost_function_(chunk_of(job, k)); });
  return std::accumulate(costs.begin(), costs.end(), 0.0);
}

Gram Problem::sum_of(const GramJob& job) const {
  std::vector<Gram> chunks(chunk_count(job));
  tbb::parallel_for(std::size_t{0}, chunks.size(),
                    [&](std::size_t k) { gram_function_(chunk_of(job, k), chunks[k]); });
  for (std::size_t k = 1; k < chunks.size(); ++k) add(chunks.front(), chunks[k]);
  return chunks.front();
}

Eigen::MatrixXd Problem::gram(std::span<const double> x, double* cost) const {
  const std::array<Coefficients, 3> channels = coefficients_at(parametrisation_, x);
  const Gram sums = sum_of(with(job(), channels));
  if (cost != nullptr) *cost = sums.cost;
  return chained(sums, channel_links(parametrisation_, channels), parametrisation_.size());
}

Eigen::MatrixXd Problem::curvature(std::span<const double> x) const {
  const std::array<Coefficients, 3> channels = coefficients_at(parametrisation_, x);
  GramJob curved = with(job(), channels);
  curved.curvature = true;
  return chained(sum_of(curved), channel_links(parametrisation_, channels), parametrisation_.size());
}

std::vector<Eigen::MatrixXd> Problem::curvature_by_group(std::span<const double> x,
                                                         std::size_t most_groups) const {
  // A multiple of every vector's length.
  constexpr std::size_t kLeast = 8;
  const std::array<Coefficients, 3> channels = coefficients_at(parametrisation_, x);
  GramJob curved = with(job(), channels);
  curved.curvature = true;
  curved.count = (samples_.size() + kLeast - 1) / kLeast * kLeast;
  const std::size_t size = (curved.count / kLeast + most_groups - 1) / most_groups * kLeast;
  const ChannelLinks chain = channel_links(parametrisation_, channels);
  std::vector<Eigen::MatrixXd> groups((curved.count + size - 1) / size);
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t k) {
    Gram sums;
    gram_function_(chunk_of(curved, k, size), sums);
    groups[k] = chained(sums, chain, parametrisation_.size());
  });
  return groups;
}

}  // namespace brdfit::fit

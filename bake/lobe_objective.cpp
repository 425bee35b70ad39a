// The leave-one-out error of a lobe set over residual classes, with its derivatives.
#include "bake/lobe_objective.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/solve_job.h"

namespace brdfit::bake {
namespace {

// Values that start on a bound are moved inside by this share of the range: at the bound nothing moves.
constexpr double kInside = 0.1;
// Directions of a class are means over its texels: those of lights far away differ by rounding alone.
constexpr double kSameDirection = 1e-12;

ClassLoss class_loss(const ResidualClass& residuals, const Eigen::MatrixXd& basis, double penalty,
                     bool with_gradient) {
  const Eigen::MatrixXd& f = residuals.factor;
  const Eigen::MatrixXd x = residuals.modulation.asDiagonal() * basis;
  Eigen::MatrixXd gram = x.transpose() * x;
  gram.diagonal().array() += penalty;
  const Eigen::MatrixXd y = gram.llt().solve(x.transpose()).transpose();
  const Eigen::MatrixXd left = f - y * (x.transpose() * f);
  const Eigen::ArrayXd hat = (x.array() * y.array()).rowwise().sum();
  const Eigen::ArrayXd inverse = (1.0 - hat).max(kLeastFreedom).inverse();
  const Eigen::ArrayXd squares = left.rowwise().squaredNorm().array();
  ClassLoss result;
  result.loss = (squares * inverse.square()).sum();
  if (!with_gradient) return result;
  // z = G y with G the derivative by the hat matrix, made symmetric.
  const Eigen::MatrixXd q = (inverse.square() * 2.0).matrix().asDiagonal() * left;
  const Eigen::VectorXd by_hat = 2.0 * squares * inverse.cube();
  const Eigen::MatrixXd z =
      by_hat.asDiagonal() * y - 0.5 * (q * (f.transpose() * y) + f * (q.transpose() * y));
  const Eigen::MatrixXd by_x = 2.0 * (z - y * (x.transpose() * z));
  result.by_basis = residuals.modulation.asDiagonal() * by_x;
  result.by_penalty = -(z.array() * y.array()).sum();
  return result;
}

double logistic(double t) {
  return 1.0 / (1.0 + std::exp(-t));
}

double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// A lobe's derivatives by the cosine to its axis, its sharpness and its inverse width.
struct LobeSlopes {
  double by_cosine;
  double by_sharpness;
  double by_width;
};

LobeSlopes slopes_of(const Lobe& lobe, double cos_axis) {
  const double width = 1.0 / (1.0 - lobe.cos_cut_off);
  const double u = (1.0 - cos_axis) * width;
  const double inside = std::max(0.0, 1.0 - u * u);
  const double peak = std::exp(lobe.sharpness * (cos_axis - 1.0));
  const double value = peak * inside * inside;
  const double edge = 4.0 * peak * inside * u;
  return {lobe.sharpness * value + edge * width, (cos_axis - 1.0) * value, -edge * (1.0 - cos_axis)};
}

bool same_directions(const ResidualClass& a, const ResidualClass& b) {
  return std::ranges::equal(a.directions, b.directions, [](const Vec3& p, const Vec3& q) {
    return std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) < kSameDirection;
  });
}

}  // namespace

LobeBounds bounds_of(std::span<const Vec3> directions) {
  const double next = spacing(cap_of(directions), directions.size());
  LobeBounds bounds;
  bounds.sharpness_high =
      std::max(2.0 * bounds.sharpness_low, std::numbers::ln10 / (1.0 - std::cos(std::min(next, 3.0))));
  bounds.least_cut_off = std::min(2.0 * next, 3.0);
  return bounds;
}

double LobeObjective::Range::value(double t) const {
  return low * std::pow(high / low, logistic(t));
}

double LobeObjective::Range::slope(double t) const {
  const double share = logistic(t);
  return value(t) * std::log(high / low) * share * (1.0 - share);
}

double LobeObjective::Range::inverse(double v) const {
  const double share = std::clamp(std::log(v / low) / std::log(high / low), kInside, 1.0 - kInside);
  return std::log(share / (1.0 - share));
}

LobeObjective::LobeObjective(std::span<const ResidualClass> classes, int lobes, const LobeBounds& bounds)
    : lobes_(lobes),
      sharpness_{bounds.sharpness_low, bounds.sharpness_high},
      width_{0.5, 1.0 / (1.0 - std::cos(bounds.least_cut_off))},
      ridge_{bounds.ridge_low, bounds.ridge_high} {
  double modulation = 0.0;
  double texels = 0.0;
  for (const ResidualClass& c : classes) {
    energy_ += c.factor.squaredNorm();
    modulation += static_cast<double>(c.texels) * c.modulation.squaredNorm();
    texels += static_cast<double>(c.texels);
    const bool is_like_last = !groups_.empty() && same_directions(*groups_.back().front(), c);
    if (!is_like_last) groups_.emplace_back();
    groups_.back().push_back(&c);
  }
  if (modulation > 0.0) unit_ = modulation / texels / lobes;
}

std::vector<double> LobeObjective::pack(const LobeSet& lobes, double ridge) const {
  std::vector<double> parameters;
  for (const Lobe& lobe : lobes) {
    parameters.insert(parameters.end(), {lobe.axis.x, lobe.axis.y, lobe.axis.z,
                                         sharpness_.inverse(std::max(lobe.sharpness, sharpness_.low)),
                                         width_.inverse(1.0 / (1.0 - lobe.cos_cut_off))});
  }
  parameters.push_back(ridge_.inverse(ridge));
  return parameters;
}

LobeSet LobeObjective::lobes(std::span<const double> parameters) const {
  LobeSet lobes;
  for (int k = 0; k < lobes_; ++k) {
    const double* p = parameters.data() + 5 * k;
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    lobes.push_back({{p[0] / length, p[1] / length, p[2] / length},
                     sharpness_.value(p[3]),
                     std::max(-1.0, 1.0 - 1.0 / width_.value(p[4]))});
  }
  return lobes;
}

double LobeObjective::ridge(std::span<const double> parameters) const {
  return ridge_.value(parameters.back());
}

// Adds to the gradient what follows from derivatives by the lobes' values under some directions.
void LobeObjective::add_chain(const std::vector<Vec3>& directions, const Eigen::MatrixXd& by_basis,
                              const LobeSet& lobes, std::span<const double> parameters,
                              double* gradient) const {
  for (std::size_t k = 0; k < lobes.size(); ++k) {
    const double* p = parameters.data() + 5 * k;
    const Vec3& axis = lobes[k].axis;
    Vec3 by_axis{0.0, 0.0, 0.0};
    double by_sharpness = 0.0;
    double by_width = 0.0;
    for (std::size_t l = 0; l < directions.size(); ++l) {
      const Vec3& d = directions[l];
      const double by_value = by_basis(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(k));
      const LobeSlopes slopes = slopes_of(lobes[k], dot(axis, d));
      const double by_cosine = by_value * slopes.by_cosine;
      by_axis = {by_axis.x + by_cosine * d.x, by_axis.y + by_cosine * d.y, by_axis.z + by_cosine * d.z};
      by_sharpness += by_value * slopes.by_sharpness;
      by_width += by_value * slopes.by_width;
    }
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double radial = dot(by_axis, axis);  // the axis's length changes nothing
    double* g = gradient + 5 * k;
    g[0] += (by_axis.x - radial * axis.x) / length;
    g[1] += (by_axis.y - radial * axis.y) / length;
    g[2] += (by_axis.z - radial * axis.z) / length;
    g[3] += by_sharpness * sharpness_.slope(p[3]);
    g[4] += by_width * width_.slope(p[4]);
  }
}

double LobeObjective::evaluate(const LobeSet& lobes, double ridge) const {
  double loss = 0.0;
  for (const auto& group : groups_) {
    const Eigen::MatrixXd basis = lobe_values(lobes, group.front()->directions);
    for (const ResidualClass* residuals : group) {
      loss += class_loss(*residuals, basis, ridge * unit_, false).loss;
    }
  }
  return energy_ > 0.0 ? loss / energy_ : 0.0;
}

double LobeObjective::evaluate(std::span<const double> parameters, double* gradient) const {
  const LobeSet set = lobes(parameters);
  if (gradient == nullptr) return evaluate(set, ridge(parameters));
  std::fill(gradient, gradient + this->parameters(), 0.0);
  double loss = 0.0;
  double by_penalty = 0.0;
  for (const auto& group : groups_) {
    const std::vector<Vec3>& directions = group.front()->directions;
    const Eigen::MatrixXd basis = lobe_values(set, directions);
    Eigen::MatrixXd by_basis = Eigen::MatrixXd::Zero(basis.rows(), basis.cols());
    for (const ResidualClass* residuals : group) {
      const ClassLoss result = class_loss(*residuals, basis, ridge(parameters) * unit_, true);
      loss += result.loss;
      by_penalty += result.by_penalty;
      by_basis += result.by_basis;
    }
    add_chain(directions, by_basis, set, parameters, gradient);
  }
  gradient[5 * lobes_] += by_penalty * unit_ * ridge_.slope(parameters.back());
  const double inverse = energy_ > 0.0 ? 1.0 / energy_ : 0.0;
  for (int k = 0; k < this->parameters(); ++k) gradient[k] *= inverse;
  return loss * inverse;
}

}  // namespace brdfit::bake

// Spheres under an environment: one quadrature per inclination of the view, and smooth interpolation between.
//
// With the light's directions given by their half vectors, d wi = 4 cos_d dh (Walter et al. 2007, eq. 14),
// and a highlight of any width sits at theta_h = 0. For a half vector at (theta_h, phi) from a view at
// theta_o, cos_d = A cos(theta_h - psi) and cos_i = A cos(2 theta_h - psi) with A^2 = cos_o^2 + (sin_o cos
// phi)^2 and tan psi = tan theta_o cos phi: the horizon is where 2 theta_h = psi + pi / 2.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "render/sphere.h"
#include "render/view.h"

namespace brdfit::render {
namespace {

constexpr double kPi = std::numbers::pi;

// Nodes and weights over [0, 1].
struct Rule {
  std::vector<double> x;
  std::vector<double> weight;
};

// Roots of the Legendre polynomial by Newton's method.
Rule gauss_legendre(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double z = std::cos(kPi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double p = 1.0;
      double before = 0.0;
      for (int k = 1; k <= n; ++k) {
        before = std::exchange(p, ((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k);
      }
      slope = n * (z * p - before) / (z * z - 1.0);
      z -= p / slope;
    }
    rule.x.push_back(0.5 * (1.0 + z));
    rule.weight.push_back(1.0 / ((1.0 - z * z) * slope * slope));
  }
  return rule;
}

// Each level has twice the nodes of the one before in both angles.
constexpr int kLevels = 4;
constexpr int kFirstPhiNodes = 24;
constexpr int kFirstThetaNodes = 8;  // per panel
constexpr int kTableLevels = 3;      // tables have kinks at every cell: they converge slowly, and cost more

struct Resolution {
  Rule phi;
  Rule theta;
};

std::array<Resolution, kLevels> make_resolutions() {
  std::array<Resolution, kLevels> result;
  for (int level = 0; level < kLevels; ++level) {
    result[static_cast<std::size_t>(level)] = {gauss_legendre(kFirstPhiNodes << level),
                                               gauss_legendre(kFirstThetaNodes << level)};
  }
  return result;
}

// What a ring of the sphere at one inclination sends to the camera: under the environment 1 + y it is
// e + n.y g - n.x u. u is 0 for materials, whose f does not change when phi_d changes its sign.
struct Ring {
  Rgb e{};
  Rgb g{};
  Rgb u{};
  double unmeasured = 0.0;  // share of the hemisphere

  Ring& add(const Ring& other, double weight) {
    for (std::size_t c = 0; c < 3; ++c) {
      e[c] += weight * other.e[c];
      g[c] += weight * other.g[c];
      u[c] += weight * other.u[c];
    }
    unmeasured += weight * other.unmeasured;
    return *this;
  }
};

// Adds up f cos_i over directions, many at a time.
class Hemisphere {
 public:
  Hemisphere(const Subject& subject, double cos_o)
      : subject_(subject), sin_o_(std::sqrt(1.0 - cos_o * cos_o)), cos_o_(cos_o) {
    for (auto* directions : {&wi_, &wo_}) directions->reserve(kBatch);
    weight_.reserve(kBatch);
  }

  void add(const Vec3& wi, double weight) {
    // Only tables tell a direction from its mirror image.
    if (subject_.table() == nullptr) return push(wi, 2.0 * weight);
    push(wi, weight);
    push({wi.x, -wi.y, wi.z}, weight);
  }

  Ring finish() {
    flush();
    ring_.unmeasured /= covered_;
    return ring_;
  }
  int evaluations() const { return evaluations_; }

 private:
  static constexpr std::size_t kBatch = 2048;

  void push(const Vec3& wi, double weight) {
    wi_.push_back(wi);
    wo_.push_back({sin_o_, 0.0, cos_o_});
    weight_.push_back(weight);
    if (wi_.size() == kBatch) flush();
  }

  void flush() {
    f_cos_.resize(wi_.size());
    state_.resize(wi_.size());
    subject_.eval_cos(wi_, wo_, f_cos_, state_);
    for (std::size_t k = 0; k < wi_.size(); ++k) {
      const double along_y = wi_[k].z - wi_[k].x * cos_o_ / sin_o_;
      const double across = wi_[k].y / sin_o_;
      for (std::size_t c = 0; c < 3; ++c) {
        const double f = weight_[k] * f_cos_[k][c];
        ring_.e[c] += f;
        ring_.g[c] += f * along_y;
        if (subject_.table() != nullptr) ring_.u[c] += f * across;
      }
      const double solid_angle = weight_[k] * wi_[k].z;
      covered_ += solid_angle;
      if (state_[k] != PixelState::kValue) ring_.unmeasured += solid_angle;
    }
    evaluations_ += static_cast<int>(wi_.size());
    wi_.clear();
    wo_.clear();
    weight_.clear();
  }

  const Subject& subject_;
  double sin_o_;
  double cos_o_;
  std::vector<Vec3> wi_;
  std::vector<Vec3> wo_;
  std::vector<double> weight_;
  std::vector<Rgb> f_cos_;
  std::vector<PixelState> state_;
  Ring ring_;
  double covered_ = 0.0;
  int evaluations_ = 0;
};

// Half vectors at one azimuth, from the normal to the horizon: panels grow from the width of the narrowest
// lobe on.
void add_azimuth(const Rule& rule, double cos_o, double phi, double d_phi, Hemisphere& hemisphere) {
  constexpr double kNarrowest = 2e-4;
  constexpr double kGrowth = 4.0;
  const double sin_o = std::sqrt(1.0 - cos_o * cos_o);
  const double b = sin_o * std::cos(phi);
  const double a = std::hypot(cos_o, b);
  const double psi = std::atan2(b, cos_o);
  const double horizon = 0.5 * psi + 0.25 * kPi;
  double begin = 0.0;
  while (begin < horizon) {
    double end = begin == 0.0 ? kNarrowest : kGrowth * begin;
    // The last panel takes a rest that would be a sliver with it.
    if (end * 1.5 > horizon) end = horizon;
    for (std::size_t k = 0; k < rule.x.size(); ++k) {
      const double theta_h = begin + rule.x[k] * (end - begin);
      const double sin_h = std::sin(theta_h);
      const double cos_d = a * std::cos(theta_h - psi);
      const Vec3 wi = {2.0 * cos_d * sin_h * std::cos(phi) - sin_o, 2.0 * cos_d * sin_h * std::sin(phi),
                       a * std::cos(2.0 * theta_h - psi)};
      hemisphere.add(wi, 4.0 * cos_d * sin_h * rule.weight[k] * (end - begin) * d_phi);
    }
    begin = end;
  }
}

// The half of the hemisphere with phi in [0, pi]. Near the silhouette the horizon turns quickly around
// phi = pi / 2: phi = pi / 2 + c sinh(t) with c = cot(theta_o) follows it.
Ring integrate(const Subject& subject, const Resolution& resolution, double cos_o, int& evaluations) {
  Hemisphere hemisphere(subject, cos_o);
  const double c = std::min(cos_o / std::sqrt(1.0 - cos_o * cos_o), 10.0);
  const double reach = std::asinh(0.5 * kPi / c);
  for (std::size_t k = 0; k < resolution.phi.x.size(); ++k) {
    const double t = (2.0 * resolution.phi.x[k] - 1.0) * reach;
    const double d_phi = c * std::cosh(t) * 2.0 * reach * resolution.phi.weight[k];
    add_azimuth(resolution.theta, cos_o, 0.5 * kPi + c * std::sinh(t), d_phi, hemisphere);
  }
  const Ring ring = hemisphere.finish();
  evaluations += hemisphere.evaluations();
  return ring;
}

// Radiance where the normal is n.
double radiance_of(Environment environment, const Ring& ring, std::size_t channel, double n_x, double n_y) {
  if (environment == Environment::kUniform) return ring.e[channel];
  return 0.5 * (ring.e[channel] + n_y * ring.g[channel] - n_x * ring.u[channel]);
}

// The largest difference between two rings at one inclination, in steps of 8-bit sRGB.
double steps_between(Environment environment, const Ring& a, const Ring& b, double cos_o) {
  const double r = std::sqrt(1.0 - cos_o * cos_o);
  double largest = 0.0;
  for (const auto& [x, y] : {std::pair{0.0, r}, {0.0, -r}, {r, 0.0}, {-r, 0.0}}) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double of_a = display_value(ViewTransform::kSrgb, radiance_of(environment, a, c, x, y));
      const double of_b = display_value(ViewTransform::kSrgb, radiance_of(environment, b, c, x, y));
      largest = std::max(largest, 255.0 * std::abs(of_a - of_b));
    }
  }
  return largest;
}

// A ring, and how well it is known.
struct Node {
  Ring ring;
  double error_steps = 0.0;
  int evaluations = 0;
};

// The whole job, apart from pixels.
struct Job {
  const Subject& subject;
  Environment environment;
  std::array<Resolution, kLevels> resolutions = make_resolutions();

  int levels() const { return subject.table() != nullptr ? kTableLevels : kLevels; }
};

// Doubles the resolution until it does not matter any more, or the work is too much.
Node make_node(const Job& job, double cos_o) {
  constexpr double kGoodEnough = 0.05;
  Node node;
  node.ring = integrate(job.subject, job.resolutions[0], cos_o, node.evaluations);
  for (int level = 1; level < job.levels(); ++level) {
    const Resolution& resolution = job.resolutions[static_cast<std::size_t>(level)];
    const Ring finer = integrate(job.subject, resolution, cos_o, node.evaluations);
    node.error_steps = steps_between(job.environment, node.ring, finer, cos_o);
    node.ring = finer;
    if (node.error_steps < kGoodEnough) break;
  }
  return node;
}

// A polynomial in cos_o through Chebyshev-Lobatto nodes, of which every other one makes one of half the
// degree.
constexpr int kDegree = 8;

struct Panel {
  double begin = 0.0;
  double end = 0.0;
  std::array<Node, kDegree + 1> nodes;
  double quadrature_steps = 0.0;     // the largest error of a node
  double interpolation_steps = 0.0;  // the largest error of the polynomial of half the degree
  int evaluations = 0;

  double error_steps() const { return quadrature_steps + interpolation_steps; }

  double place(int k) const {
    return 0.5 * (begin + end) - 0.5 * (end - begin) * std::cos(kPi * k / kDegree);
  }

  // Barycentric interpolation (Berrut and Trefethen 2004) through every stride-th node.
  Ring at(double cos_o, int stride = 1) const {
    Ring sum;
    double weights = 0.0;
    double sign = 1.0;
    for (int k = 0; k <= kDegree; k += stride, sign = -sign) {
      const Ring& ring = nodes[static_cast<std::size_t>(k)].ring;
      const double distance = cos_o - place(k);
      if (distance == 0.0) return ring;
      const double weight = (k == 0 || k == kDegree ? 0.5 : 1.0) * sign / distance;
      sum.add(ring, weight);
      weights += weight;
    }
    return Ring().add(sum, 1.0 / weights);
  }
};

Panel make_panel(const Job& job, double begin, double end) {
  Panel panel;
  panel.begin = begin;
  panel.end = end;
  tbb::parallel_for(0, kDegree + 1, [&](int k) {
    panel.nodes[static_cast<std::size_t>(k)] = make_node(job, panel.place(k));
  });
  for (int k = 0; k <= kDegree; ++k) {
    const Node& node = panel.nodes[static_cast<std::size_t>(k)];
    const double cos_o = panel.place(k);
    const double gap = steps_between(job.environment, node.ring, panel.at(cos_o, 2), cos_o);
    panel.evaluations += node.evaluations;
    panel.quadrature_steps = std::max(panel.quadrature_steps, node.error_steps);
    panel.interpolation_steps = std::max(panel.interpolation_steps, gap);
  }
  return panel;
}

// Panels in order; one that does not resolve the subject is cut in two. Where nodes themselves are not known
// well, cutting would only chase their errors.
std::vector<Panel> make_panels(const Job& job, double begin, double end, int cuts) {
  constexpr double kGoodEnough = 0.15;
  constexpr int kMostCuts = 3;
  const Panel panel = make_panel(job, begin, end);
  const double wanted = std::max(kGoodEnough, 2.0 * panel.quadrature_steps);
  if (panel.interpolation_steps < wanted || cuts == kMostCuts) return {panel};
  const double middle = std::sqrt(begin * end);
  std::vector<Panel> result = make_panels(job, begin, middle, cuts + 1);
  const std::vector<Panel> upper = make_panels(job, middle, end, cuts + 1);
  result.insert(result.end(), upper.begin(), upper.end());
  result.front().evaluations += panel.evaluations;
  return result;
}

// cos_o of a pixel, or 0 beside the sphere.
double cos_o_of(const Scene& scene, int x, int y) {
  const SurfacePoint point = scene.at(x, y);
  return point.inside ? point.wo.z : 0.0;
}

// The lowest inclination that the picture shows.
double lowest_cosine(const Scene& scene, int size) {
  double lowest = 1.0;
  for (int y = 0; y < (size + 1) / 2; ++y) {
    // The first pixel of a row that lies on the sphere is the one nearest to the silhouette.
    for (int x = 0; x < (size + 1) / 2; ++x) {
      const double cos_o = cos_o_of(scene, x, y);
      if (cos_o == 0.0) continue;
      lowest = std::min(lowest, cos_o);
      break;
    }
  }
  return lowest;
}

// The polynomial next to the pole reaches it from here: at the pole itself g is 0 / 0.
constexpr double kHighestCosine = 0.999;

std::vector<Panel> tabulate(const Job& job, double lowest) {
  constexpr double kGrowth = 4.0;
  std::vector<std::pair<double, double>> ranges;
  for (double begin = std::min(lowest, 0.9 * kHighestCosine); begin < kHighestCosine;) {
    const double end = begin * kGrowth * 1.2 > kHighestCosine ? kHighestCosine : begin * kGrowth;
    ranges.emplace_back(begin, end);
    begin = end;
  }
  std::vector<std::vector<Panel>> parts(ranges.size());
  tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t k) {
    parts[k] = make_panels(job, ranges[k].first, ranges[k].second, 0);
  });
  std::vector<Panel> panels;
  for (const auto& part : parts) panels.insert(panels.end(), part.begin(), part.end());
  return panels;
}

const Panel& panel_for(const std::vector<Panel>& panels, double cos_o) {
  const auto found = std::ranges::find_if(panels, [&](const Panel& panel) { return cos_o <= panel.end; });
  return found == panels.end() ? panels.back() : *found;
}

void store(const Rgb& radiance, std::size_t pixel, Image& image) {
  bool finite = true;
  for (std::size_t c = 0; c < 3; ++c) {
    // A polynomial may pass below 0 between nodes near it.
    image.rgb[3 * pixel + c] = static_cast<float>(std::max(radiance[c], 0.0));
    finite = finite && std::isfinite(image.rgb[3 * pixel + c]);
  }
  if (finite) return;
  image.state[pixel] = PixelState::kNotFinite;
  for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * pixel + c] = 0.0F;
}

Image draw_pixels(Environment environment, const std::vector<Panel>& panels, const Scene& scene, int size) {
  Image image(size, size);
  tbb::parallel_for(0, size, [&](int y) {
    for (int x = 0; x < size; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
      const double cos_o = cos_o_of(scene, x, y);
      if (cos_o == 0.0) {
        image.state[pixel] = PixelState::kOutside;
        continue;
      }
      const Ring ring = panel_for(panels, cos_o).at(cos_o);
      const double n_x = (2.0 * x + 1.0 - size) / size;
      const double n_y = (size - 1.0 - 2.0 * y) / size;
      Rgb radiance;
      for (std::size_t c = 0; c < 3; ++c) radiance[c] = radiance_of(environment, ring, c, n_x, n_y);
      store(radiance, pixel, image);
    }
  });
  return image;
}

bool is_anisotropic(const Subject& subject) {
  const Material* material = subject.material();
  return material != nullptr && material->model() == Model::kBurley &&
         material->effects().has(Effect::kAnisotropic) && material->number("anisotropic") != 0.0;
}

}  // namespace

EnvironmentImage draw_environment(const Subject& subject, Environment environment, int size) {
  if (is_anisotropic(subject)) {
    throw std::invalid_argument("an anisotropic material cannot be drawn under an environment");
  }
  const Scene scene(Shape::kSphere, 0.0, size);
  const Job job = {subject, environment};
  const std::vector<Panel> panels = tabulate(job, lowest_cosine(scene, size));
  EnvironmentImage result;
  for (const Panel& panel : panels) {
    result.error_steps = std::max(result.error_steps, panel.error_steps());
    result.evaluations += panel.evaluations;
    for (const Node& node : panel.nodes) {
      result.unmeasured_fraction = std::max(result.unmeasured_fraction, node.ring.unmeasured);
    }
  }
  result.converged = result.error_steps < 0.5;
  result.image = draw_pixels(environment, panels, scene, size);
  return result;
}

}  // namespace brdfit::render

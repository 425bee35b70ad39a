// With the second moments C of the lights' pictures over texels, the energy that a set of directions D (one
// row a light) explains is tr(Q' C Q), Q an orthonormal basis of D's columns. A hypothesis that permutes
// lights costs no pass over texels.
#include "bake/light_check.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

namespace brdfit::bake {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;
using Order = std::vector<Index>;

constexpr double kClearlyBetter = 2.0 / 3.0;  // of the residual's energy, or of the curl
constexpr std::size_t kFewestLights = 4;
constexpr std::size_t kFewestTriples = 30;
constexpr double kSameDirection = 0.999999;  // cosine: 0.08 deg
constexpr double kSamePicture = 1.0 - 1e-9;  // correlation of values; cameras' noise is far below it
constexpr std::size_t kSwapCandidates = 48;  // grazing lights come before them
constexpr double kOtherStrength = 1.5;
constexpr double kFarOffDeg = 10.0;

std::uint32_t neighbour_step(const StackInfo& info) {
  return static_cast<std::uint32_t>(std::clamp(std::min(info.width, info.height) / 200, 1, 4));
}

// Luminance per light (rows) and texel (columns), with highlights limited; NaN-free. Texels that miss values
// or are black stay zero.
Matrix limited_values(const StackInfo& info, const TexelBlock& block) {
  const auto lights = static_cast<Index>(block.lights);
  const auto texels = static_cast<Index>(block.count());
  Matrix values(lights, texels);
  std::vector<double> column(block.lights);
  for (Index t = 0; t < texels; ++t) {
    const auto texel = static_cast<std::size_t>(t);
    bool is_whole = true;
    for (std::size_t l = 0; l < block.lights; ++l) {
      const Rgb& intensity = info.lights[l].intensity;
      double sum = 0.0;
      for (std::size_t c = 0; c < block.channels; ++c) {
        sum += static_cast<double>(block.plane(l, c)[texel]) / intensity[block.channels == 1 ? 1 : c];
      }
      const double falloff = incidence(info, l, block.texels[texel]).falloff;
      column[l] = sum / (static_cast<double>(block.channels) * falloff);
      is_whole = is_whole && std::isfinite(column[l]);
    }
    std::vector<double> sorted = column;
    const auto high = sorted.begin() + static_cast<std::ptrdiff_t>(9 * (sorted.size() - 1) / 10);
    std::nth_element(sorted.begin(), high, sorted.end());
    for (Index l = 0; l < lights; ++l) {
      values(l, t) = is_whole ? std::min(column[static_cast<std::size_t>(l)], *high) : 0.0;
    }
  }
  return values;
}

Matrix direction_rows(const StackInfo& info) {
  Matrix directions(static_cast<Index>(info.lights.size()), 3);
  for (Index l = 0; l < directions.rows(); ++l) {
    const Vec3& d = info.lights[static_cast<std::size_t>(l)].direction;
    directions.row(l) << d.x, d.y, d.z;
  }
  return directions;
}

// Energy that no Lambert surface explains when light l has the direction of light order[l].
class Explainer {
 public:
  Explainer(Matrix moments, const Matrix& directions)
      : moments_(std::move(moments)), total_(moments_.trace()) {
    const Eigen::HouseholderQR<Matrix> qr(directions);
    basis_ = qr.householderQ() * Matrix::Identity(directions.rows(), 3);
  }

  double residual(const Order& order) const {
    const Matrix q = permuted(order);
    return std::max(0.0, total_ - (q.transpose() * moments_ * q).trace()) / total_;
  }

  // Each light's share of its own energy.
  Eigen::VectorXd residual_of_lights(const Order& order) const {
    const Matrix q = permuted(order);
    const Matrix projected = moments_ * q;
    const Matrix inner = q.transpose() * projected;
    Eigen::VectorXd shares(q.rows());
    for (Index l = 0; l < q.rows(); ++l) {
      const double own = moments_(l, l);
      const double left =
          own - 2.0 * projected.row(l).dot(q.row(l)) + q.row(l).dot(inner * q.row(l).transpose());
      shares[l] = own > 0.0 ? std::max(0.0, left) / own : 0.0;
    }
    return shares;
  }

 private:
  Matrix permuted(const Order& order) const {
    Matrix q(basis_.rows(), 3);
    for (Index l = 0; l < q.rows(); ++l) q.row(l) = basis_.row(order[static_cast<std::size_t>(l)]);
    return q;
  }

  Matrix moments_;
  double total_;
  Matrix basis_;
};

Order as_listed(Index lights) {
  Order order(static_cast<std::size_t>(lights));
  std::iota(order.begin(), order.end(), Index{0});
  return order;
}

// "light 2.png" before "light 10.png", which an alphabet puts the other way round.
bool is_before_by_number(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto number = [&](const std::string& text, std::size_t& at) {
        double value = 0.0;
        for (; at < text.size() && is_digit(text[at]); ++at) value = 10.0 * value + (text[at] - '0');
        return value;
      };
      const double x = number(a, i), y = number(b, j);
      if (x != y) return x < y;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

// Directions in the order of names by alphabet where pictures are in that of their numbers, or the reverse.
Order number_order(const StackInfo& info) {
  Order order = as_listed(static_cast<Index>(info.lights.size()));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return is_before_by_number(info.lights[static_cast<std::size_t>(a)].name,
                               info.lights[static_cast<std::size_t>(b)].name);
  });
  return order;
}

Order inverse_of(const Order& order) {
  Order inverse(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    inverse[static_cast<std::size_t>(order[k])] = static_cast<Index>(k);
  return inverse;
}

class Checker {
 public:
  Checker(const StackInfo& info, const TexelBlock& block)
      : info_(info), block_(block), values_(limited_values(info, block)), directions_(direction_rows(info)) {}

  LightCheck run() {
    LightCheck result;
    find_same_directions(result);
    if (info_.lights.size() < kFewestLights || block_.count() < 3 * kFewestTriples ||
        values_.squaredNorm() <= 0.0) {
      return result;
    }
    const Matrix moments = values_ * values_.transpose();
    find_same_pictures(moments, result);
    const Explainer explainer(moments, directions_);
    const Order listed = as_listed(directions_.rows());
    result.texels = block_.count();
    result.lambert_residual = std::sqrt(explainer.residual(listed));
    const Eigen::VectorXd shares = explainer.residual_of_lights(listed);
    for (Index l = 0; l < shares.size(); ++l) result.of_light.push_back(std::sqrt(shares[l]));
    if (!find_order(explainer, result)) find_swaps(explainer, result);
    find_symmetry(result);
    return result;
  }

 private:
  const std::string& name(std::size_t light) const { return info_.lights[light].name; }

  void find_same_directions(LightCheck& result) const {
    for (std::size_t a = 0; a < info_.lights.size(); ++a) {
      for (std::size_t b = a + 1; b < info_.lights.size(); ++b) {
        const double cosine =
            directions_.row(static_cast<Index>(a)).dot(directions_.row(static_cast<Index>(b)));
        if (cosine < kSameDirection || info_.lights[a].position || info_.lights[b].position) continue;
        result.suspicions.push_back({"same direction",
                                     fmt::format("{} and {} have the same light direction", name(a), name(b)),
                                     {a, b}});
      }
    }
  }

  void find_same_pictures(const Matrix& moments, LightCheck& result) const {
    for (Index a = 0; a < moments.rows(); ++a) {
      for (Index b = a + 1; b < moments.rows(); ++b) {
        const double product = moments(a, a) * moments(b, b);
        if (product <= 0.0 || moments(a, b) * moments(a, b) < kSamePicture * product) continue;
        const auto first = static_cast<std::size_t>(a), second = static_cast<std::size_t>(b);
        result.suspicions.push_back(
            {"same picture",
             fmt::format("{} and {} hold the same picture", name(first), name(second)),
             {first, second}});
      }
    }
  }

  // All lights in another order.
  bool find_order(const Explainer& explainer, LightCheck& result) const {
    const double listed = explainer.residual(as_listed(directions_.rows()));
    struct Candidate {
      std::string text;
      Order order;
    };
    std::vector<Candidate> candidates;
    Order order = as_listed(directions_.rows());
    std::reverse(order.begin(), order.end());
    candidates.push_back({"in reverse order", order});
    for (const bool is_forward : {true, false}) {
      order = as_listed(directions_.rows());
      std::rotate(order.begin(), is_forward ? order.begin() + 1 : order.end() - 1, order.end());
      candidates.push_back({is_forward ? "one place later" : "one place earlier", order});
    }
    candidates.push_back({"sorted by number rather than by alphabet", number_order(info_)});
    candidates.push_back({"sorted by alphabet rather than by number", inverse_of(number_order(info_))});
    const Candidate* best = nullptr;
    double least = kClearlyBetter * listed;
    for (const Candidate& candidate : candidates) {
      const double residual = explainer.residual(candidate.order);
      if (residual >= least) continue;
      least = residual;
      best = &candidate;
    }
    if (best == nullptr) return false;
    result.suspicions.push_back(
        {"wrong order",
         fmt::format(
             "light directions fit the pictures better {}: Lambert residual {:.1f}% instead of {:.1f}%",
             best->text, 100.0 * std::sqrt(least), 100.0 * std::sqrt(listed)),
         {}});
    return true;
  }

  // Pairs, the best one first, as long as each takes away a third of what its two lights leave unexplained.
  void find_swaps(const Explainer& explainer, LightCheck& result) const {
    Order order = as_listed(directions_.rows());
    while (const auto swap = best_swap(explainer, order)) {
      const auto [a, b] = *swap;
      std::swap(order[static_cast<std::size_t>(a)], order[static_cast<std::size_t>(b)]);
      const auto first = static_cast<std::size_t>(std::min(a, b)),
                 second = static_cast<std::size_t>(std::max(a, b));
      result.suspicions.push_back(
          {"swapped lights",
           fmt::format("the lights of {} and {} seem to be swapped", name(first), name(second)),
           {first, second}});
    }
    find_misplaced(order, result);
  }

  // What another direction and strength of a light would explain of its picture.
  struct Better {
    Index light = 0;
    Eigen::Vector3d direction;  // times strength
    double angle_deg = 0.0;
    double gain = 0.0;  // energy that it explains beyond the listed direction
  };

  // The light that gains most, if any gains much. Albedo times normal is taken from the lights that are
  // trusted, without the one in question, so that a wrong one does not speak for itself. Grazing lights fit
  // badly whatever their direction (cast shadows), so a bad fit alone says nothing.
  std::optional<Better> most_misplaced(const Matrix& listed, const std::vector<bool>& is_trusted) const {
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    Matrix right_side = Matrix::Zero(3, values_.cols());
    for (Index l = 0; l < listed.rows(); ++l) {
      if (!is_trusted[static_cast<std::size_t>(l)]) continue;
      gram += listed.row(l).transpose() * listed.row(l);
      right_side += listed.row(l).transpose() * values_.row(l);
    }
    std::optional<Better> found;
    for (Index l = 0; l < listed.rows(); ++l) {
      if (!is_trusted[static_cast<std::size_t>(l)]) continue;
      const Eigen::RowVectorXd picture = values_.row(l);
      const Eigen::Vector3d direction = listed.row(l).transpose();
      const Matrix surface = Eigen::LDLT<Eigen::Matrix3d>(gram - direction * direction.transpose())
                                 .solve(right_side - direction * picture);
      const Eigen::Matrix3d moments = surface * surface.transpose();
      const Eigen::Vector3d best = Eigen::LDLT<Eigen::Matrix3d>(moments).solve(surface * picture.transpose());
      const double left = (picture - best.transpose() * surface).squaredNorm();
      const double as_listed_left = (picture - direction.transpose() * surface).squaredNorm();
      if (!(best.norm() > 0.0) || !(left < 0.25 * as_listed_left)) continue;
      // Shadows pull the best direction aside; where strength alone explains nearly as much, it is that.
      const Eigen::RowVectorXd expected = direction.transpose() * surface;
      const double gain = picture.dot(expected) / expected.squaredNorm();
      const double gained_left = (picture - gain * expected).squaredNorm();
      const bool is_gain = as_listed_left - gained_left > 0.8 * (as_listed_left - left);
      const Eigen::Vector3d better = is_gain ? Eigen::Vector3d(gain * direction) : best;
      const double strength = better.norm();
      const double cosine = std::clamp(better.dot(direction) / strength, -1.0, 1.0);
      const double angle = std::acos(cosine) * 180.0 / std::numbers::pi;
      const bool is_much = angle > kFarOffDeg || strength < 1.0 / kOtherStrength || strength > kOtherStrength;
      if (!is_much || (found && as_listed_left - left <= found->gain)) continue;
      found = {l, better, angle, as_listed_left - left};
    }
    return found;
  }

  void find_misplaced(const Order& order, LightCheck& result) const {
    Matrix listed(directions_.rows(), 3);
    for (Index l = 0; l < listed.rows(); ++l)
      listed.row(l) = directions_.row(order[static_cast<std::size_t>(l)]);
    std::vector<bool> is_trusted(order.size(), true);
    // Where many are wrong, the rest is no judge.
    for (std::size_t most = order.size() / 4; most > 0; --most) {
      const std::optional<Better> found = most_misplaced(listed, is_trusted);
      if (!found) return;
      const auto light = static_cast<std::size_t>(found->light);
      is_trusted[light] = false;
      const double strength = found->direction.norm();
      const Eigen::Vector3d unit = found->direction / strength;
      if (found->angle_deg > kFarOffDeg) {
        result.suspicions.push_back(
            {"misplaced light",
             fmt::format("{} looks lit from ({:.2f}, {:.2f}, {:.2f}), {:.0f} deg from its direction",
                         name(light), unit.x(), unit.y(), unit.z(), found->angle_deg),
             {light}});
      } else {
        result.suspicions.push_back(
            {"other strength",
             fmt::format("{} looks {:.2g} times as bright as its light should make it", name(light),
                         strength),
             {light}});
      }
    }
  }

  static std::optional<std::pair<Index, Index>> best_swap(const Explainer& explainer, const Order& order) {
    const Eigen::VectorXd shares = explainer.residual_of_lights(order);
    Order worst = as_listed(shares.size());
    std::stable_sort(worst.begin(), worst.end(), [&](Index a, Index b) { return shares[a] > shares[b]; });
    worst.resize(std::min(worst.size(), kSwapCandidates));
    std::optional<std::pair<Index, Index>> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < worst.size(); ++i) {
      for (std::size_t j = i + 1; j < worst.size(); ++j) {
        const Index a = worst[i], b = worst[j];
        Order swapped = order;
        std::swap(swapped[static_cast<std::size_t>(a)], swapped[static_cast<std::size_t>(b)]);
        const Eigen::VectorXd after = explainer.residual_of_lights(swapped);
        // Lights next to each other differ little: only what is large before and small after counts.
        const bool is_clear = after[a] < 0.25 * shares[a] && after[b] < 0.25 * shares[b];
        const double total = after.sum();
        if (!is_clear || total >= least) continue;
        least = total;
        best = {a, b};
      }
    }
    return best;
  }

  // Slopes of the surface that Lambert's law gives at each texel: p = dz/dx, q = dz/dy.
  struct Slopes {
    std::vector<double> p, q;
    std::vector<bool> is_sound;
  };

  Slopes slopes() const {
    const Eigen::ColPivHouseholderQR<Matrix> qr(directions_);
    const Matrix normals = qr.solve(values_);
    Slopes result;
    for (Index t = 0; t < normals.cols(); ++t) {
      const double z = normals(2, t);
      // Steeper than 75 deg, or black: no slope to be trusted.
      const bool is_sound = z > 0.25 * normals.col(t).norm();
      result.is_sound.push_back(is_sound);
      result.p.push_back(is_sound ? -normals(0, t) / z : 0.0);
      result.q.push_back(is_sound ? -normals(1, t) / z : 0.0);
    }
    return result;
  }

  // Sums over triples of neighbours of the four curls that the symmetries of a square lead to.
  struct Curls {
    double as_is = 0.0, mirrored = 0.0, transposed = 0.0, turned = 0.0;
    std::size_t triples = 0;
  };

  Curls curls(const Slopes& slopes) const {
    const std::uint32_t step = neighbour_step(info_);
    const auto width = static_cast<std::uint32_t>(info_.width);
    const auto place = [&](std::uint32_t texel) -> std::optional<std::size_t> {
      const auto at = std::lower_bound(block_.texels.begin(), block_.texels.end(), texel);
      if (at == block_.texels.end() || *at != texel) return {};
      const auto k = static_cast<std::size_t>(at - block_.texels.begin());
      return slopes.is_sound[k] ? std::optional(k) : std::nullopt;
    };
    Curls sums;
    for (const std::uint32_t texel : block_.texels) {
      if (texel % width + step >= width) continue;
      const auto here = place(texel), right = place(texel + step), below = place(texel + step * width);
      if (!here || !right || !below) continue;
      const double p_x = slopes.p[*right] - slopes.p[*here], p_y = slopes.p[*here] - slopes.p[*below];
      const double q_x = slopes.q[*right] - slopes.q[*here], q_y = slopes.q[*here] - slopes.q[*below];
      sums.as_is += std::abs(p_y - q_x);
      sums.mirrored += std::abs(p_y + q_x);
      sums.transposed += std::abs(q_y - p_x);
      sums.turned += std::abs(q_y + p_x);
      ++sums.triples;
    }
    return sums;
  }

  // Correlation of a slope with its coordinate: below 0 for a hump.
  double hump(const std::vector<double>& slope, const std::vector<bool>& is_sound, bool is_x) const {
    double n = 0.0, s = 0.0, ss = 0.0, c = 0.0, cc = 0.0, sc = 0.0;
    for (std::size_t k = 0; k < slope.size(); ++k) {
      if (!is_sound[k]) continue;
      const auto width = static_cast<std::uint32_t>(info_.width);
      const double at = is_x ? block_.texels[k] % width : -static_cast<double>(block_.texels[k] / width);
      n += 1.0, s += slope[k], ss += slope[k] * slope[k], c += at, cc += at * at, sc += slope[k] * at;
    }
    const double spread = (n * ss - s * s) * (n * cc - c * c);
    return spread > 0.0 ? (n * sc - s * c) / std::sqrt(spread) : 0.0;
  }

  void find_symmetry(LightCheck& result) const {
    const Slopes found = slopes();
    const Curls sums = curls(found);
    if (sums.triples < kFewestTriples) return;
    const double across = hump(found.p, found.is_sound, true);
    const double upward = hump(found.q, found.is_sound, false);
    const double least = std::min({sums.mirrored, sums.transposed, sums.turned});
    const auto evidence = [&](double sum) {
      return fmt::format("the slopes that follow are integrable that way (curl {:.2f} of the listed one's)",
                         sum / sums.as_is);
    };
    const auto add = [&](std::string kind, std::string text) {
      result.suspicions.push_back({std::move(kind), std::move(text), {}});
    };
    constexpr double kClearHump = 0.3;
    if (least < kClearlyBetter * sums.as_is) {
      if (least == sums.mirrored) {
        const char* which = upward > across + kClearHump   ? "y of the light directions seems upside down"
                            : across > upward + kClearHump ? "x of the light directions seems mirrored"
                                                           : "x or y of the light directions seems mirrored";
        add("mirrored", fmt::format("{}: {}", which, evidence(least)));
      } else if (least == sums.transposed) {
        add("transposed", fmt::format("x and y of the light directions seem swapped: {}", evidence(least)));
      } else {
        add("turned by 90 deg", fmt::format("light directions seem turned by 90 deg: {}", evidence(least)));
      }
    } else if (across > kClearHump && upward > kClearHump) {
      add("opposite side",
          "the surface seems hollow: it is, or x and y of the light directions have the wrong sign");
    }
  }

  const StackInfo& info_;
  const TexelBlock& block_;
  Matrix values_;
  Matrix directions_;
};

}  // namespace

std::vector<std::uint32_t> light_check_texels(const StackInfo& info, std::size_t triples) {
  const auto step = static_cast<int>(neighbour_step(info));
  const int width = info.width - step, height = info.height - step;
  std::vector<std::uint32_t> texels;
  if (width < 1 || height < 1) return texels;
  const double spacing = std::max(1.0, std::sqrt(static_cast<double>(width) * height /
                                                 static_cast<double>(std::max<std::size_t>(1, triples))));
  for (double y = 0.5 * (spacing - 1.0); y < height; y += spacing) {
    for (double x = 0.5 * (spacing - 1.0); x < width; x += spacing) {
      const auto texel = static_cast<std::uint32_t>(static_cast<int>(y) * info.width + static_cast<int>(x));
      texels.push_back(texel);
      texels.push_back(texel + static_cast<std::uint32_t>(step));
      texels.push_back(texel + static_cast<std::uint32_t>(step * info.width));
    }
  }
  std::sort(texels.begin(), texels.end());
  texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
  return texels;
}

LightCheck check_lights(const StackInfo& info, const TexelBlock& block) {
  return Checker(info, block).run();
}

}  // namespace brdfit::bake

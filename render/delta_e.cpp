// Colour differences of spheres.
#include "render/delta_e.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "brdf/half_diff.h"
#include "brdf/simd/dispatch.h"
#include "render/delta_e_job.h"
#include "render/itp.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void convert_to_itp(const render::ItpJob&))
BRDFIT_DECLARE_SIMD(render::DeltaESum sum_delta_e(const render::DeltaEJob&))

}  // namespace brdfit::simd

namespace brdfit::render {
namespace {

constexpr double kSteps = 720.0;  // just noticeable differences per unit of ITP (BT.2124)
constexpr std::size_t kChunk = 8 * simd::kBlock;

using ItpColumns = std::array<float*, 3>;

ItpFunction itp_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), convert_to_itp);
}

DeltaEFunction delta_e_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), sum_delta_e);
}

// f cos_i of a chunk, column by column.
struct Values {
  std::array<std::array<double, kChunk>, 3> f_cos;

  void to_itp(std::size_t count, const ItpColumns& itp) const {
    itp_function()({{f_cos[0].data(), f_cos[1].data(), f_cos[2].data()}, {itp[0], itp[1], itp[2]}, count});
  }
};

// Puts f cos_i of a pixel into its place; false where the table holds nothing.
bool put(const std::optional<Rgb>& f, double cos_i, std::size_t k, Values& values) {
  for (std::size_t c = 0; c < 3; ++c) values.f_cos[c][k] = f ? (*f)[c] * cos_i : 0.0;
  return f.has_value();
}

// Colours of a chunk of a table, on the upper half and its mirror image, where phi_d has the other sign.
void evaluate_table(const MeasuredTable& table, const std::array<const double*, 6>& w, std::size_t count,
                    std::size_t padded, const ItpColumns& upper, const ItpColumns& lower) {
  std::array<Values, 2> values;
  std::array<std::array<bool, kChunk>, 2> held;
  for (std::size_t k = 0; k < padded; ++k) {
    const HalfDiff angles =
        half_diff_from_directions({w[0][k], w[1][k], w[2][k]}, {w[3][k], w[4][k], w[5][k]});
    const HalfDiff mirrored = {angles.theta_h_rad, angles.theta_d_rad, -angles.phi_d_rad};
    held[0][k] = put(table.interpolate(angles), w[2][k], k, values[0]) && k < count;
    held[1][k] = put(table.interpolate(mirrored), w[2][k], k, values[1]) && k < count;
  }
  for (std::size_t half = 0; half < 2; ++half) {
    const ItpColumns& itp = half == 0 ? upper : lower;
    values[half].to_itp(padded, itp);
    for (std::size_t k = 0; k < padded; ++k) {
      if (!held[half][k]) itp[0][k] = kNoColour;
    }
  }
}

void evaluate_material(const Material& material, const std::array<const double*, 6>& w, std::size_t count,
                       std::size_t padded, const ItpColumns& itp) {
  Values values;
  double* const out[3] = {values.f_cos[0].data(), values.f_cos[1].data(), values.f_cos[2].data()};
  simd::eval_directions(simd::best_isa())(simd::coefficients_of(material),
                                          {w[0], w[1], w[2], w[3], w[4], w[5]}, padded, out);
  values.to_itp(padded, itp);
  std::fill(itp[0] + count, itp[0] + padded, kNoColour);
}

std::size_t padded_to_block(std::size_t count) {
  return (count + simd::kBlock - 1) / simd::kBlock * simd::kBlock;
}

std::array<float*, 3> columns_at(std::array<std::vector<float>, 3>& itp, std::size_t first) {
  if (itp[0].empty()) return {};
  return {itp[0].data() + first, itp[1].data() + first, itp[2].data() + first};
}

}  // namespace

Rgb itp_from_linear(const Rgb& linear) {
  const Itp<double> itp = itp_of(linear[0], linear[1], linear[2]);
  return {itp.i, itp.t, itp.p};
}

double delta_e_itp(const Rgb& itp_a, const Rgb& itp_b) {
  return kSteps * std::hypot(itp_a[0] - itp_b[0], itp_a[1] - itp_b[1], itp_a[2] - itp_b[2]);
}

SphereJudge::SphereJudge(const Subject& reference, int size) : size_(size) {
  if (size % 2 != 0) throw std::invalid_argument("SphereJudge: the size is odd");
  for (std::size_t light = 0; light < kLightAnglesDeg.size(); ++light) collect_pixels(light);
  const std::size_t padded = directions_[0].size();
  for (auto& column : upper_.itp) column.resize(padded);
  if (reference.table() != nullptr) {
    for (auto& column : lower_.itp) column.resize(padded);
  }
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t k) {
    evaluate(reference, chunks_[k], columns_at(upper_.itp, chunks_[k].first),
             columns_at(lower_.itp, chunks_[k].first));
  });
}

void SphereJudge::collect_pixels(std::size_t light) {
  const Scene scene(Shape::kSphere, kLightAnglesDeg[light], size_);
  const std::size_t begin = directions_[0].size();
  half_pixels_ = 0;
  for (int y = 0; y < size_ / 2; ++y) {
    for (int x = 0; x < size_; ++x) {
      const SurfacePoint point = scene.at(x, y);
      if (!point.inside) continue;
      ++half_pixels_;
      if (point.wi.z <= 0.0) continue;
      const std::array<double, 6> pair = {point.wi.x, point.wi.y, point.wi.z,
                                          point.wo.x, point.wo.y, point.wo.z};
      for (std::size_t c = 0; c < 6; ++c) directions_[c].push_back(pair[c]);
    }
  }
  const std::size_t end = directions_[0].size();
  for (std::size_t first = begin; first < end; first += kChunk) {
    const std::size_t count = std::min(kChunk, end - first);
    chunks_.push_back({light, first, count, padded_to_block(count)});
  }
  // Padding repeats the last pixel.
  if (end == begin) return;
  for (auto& column : directions_) column.resize(begin + padded_to_block(end - begin), column.back());
}

void SphereJudge::evaluate(const Subject& subject, const Chunk& chunk, const std::array<float*, 3>& upper,
                           const std::array<float*, 3>& lower) const {
  std::array<const double*, 6> w;
  for (std::size_t c = 0; c < 6; ++c) w[c] = directions_[c].data() + chunk.first;
  if (subject.table() != nullptr) {
    evaluate_table(*subject.table(), w, chunk.count, chunk.padded, upper, lower);
  } else {
    evaluate_material(*subject.material(), w, chunk.count, chunk.padded, upper);
  }
}

SphereDeltaE SphereJudge::operator()(const Subject& candidate) const {
  const bool reference_is_table = !lower_.itp[0].empty();
  const bool candidate_is_table = candidate.table() != nullptr;
  // Where both halves of both subjects are alike, one of them says it all.
  const bool both_halves = reference_is_table || candidate_is_table;
  std::vector<DeltaESum> sums(chunks_.size());
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t k) {
    const Chunk& chunk = chunks_[k];
    std::array<std::array<float, kChunk>, 6> colours;
    const ItpColumns upper = {colours[0].data(), colours[1].data(), colours[2].data()};
    const ItpColumns lower = {colours[3].data(), colours[4].data(), colours[5].data()};
    evaluate(candidate, chunk, upper, lower);
    const auto compare = [&](const Colours& reference, const ItpColumns& itp) {
      const auto& r = reference.itp;
      return delta_e_function()(
          {{r[0].data() + chunk.first, r[1].data() + chunk.first, r[2].data() + chunk.first},
           {itp[0], itp[1], itp[2]},
           chunk.padded});
    };
    const DeltaESum first = compare(upper_, upper);
    const DeltaESum second =
        both_halves ? compare(reference_is_table ? lower_ : upper_, candidate_is_table ? lower : upper)
                    : first;
    sums[k] = {first.distance + second.distance, first.pairs + second.pairs};
  });
  return totals_of(sums);
}

SphereDeltaE SphereJudge::totals_of(std::span<const DeltaESum> sums) const {
  SphereDeltaE result;
  std::array<double, 4> distance{};
  std::array<std::size_t, 4> pixels;
  pixels.fill(2 * half_pixels_);
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    const std::size_t missing = 2 * chunks_[k].count - static_cast<std::size_t>(sums[k].pairs);
    distance[chunks_[k].light] += kSteps * sums[k].distance;
    pixels[chunks_[k].light] -= missing;
    result.skipped += missing;
  }
  double total = 0.0;
  for (std::size_t light = 0; light < distance.size(); ++light) {
    const auto n = static_cast<double>(pixels[light]);
    if (pixels[light] > 0) result.by_light[light] = distance[light] / n;
    total += distance[light];
    result.pixels += pixels[light];
  }
  if (result.pixels > 0) result.mean = total / static_cast<double>(result.pixels);
  return result;
}

}  // namespace brdfit::render

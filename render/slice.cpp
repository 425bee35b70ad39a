// Pictures of BRDF slices: samples along both sides, evaluated row by row.
#include "render/slice.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "brdf/simd/dispatch.h"
#include "measured/grid_geometry.h"
#include "measured/slice.h"

namespace brdfit::render {
namespace {

using Angle = GridGeometry::Angle;

constexpr double kHalfPi = 0.5 * std::numbers::pi;
constexpr int kLargestSize = 16384;
constexpr int kLargestDimension = 65536;

const Grid& grid_of(const Subject& subject, const SliceOptions& options) {
  return subject.table() != nullptr ? subject.table()->grid() : options.grid;
}

// The cell in which the centre of a pixel lies, of `cells` even ones along `size` pixels. In whole numbers,
// as rounding would decide ties: a centre on an edge belongs to the cell that begins there.
int even_cell(int pixel, int size, int cells) {
  return static_cast<int>((2 * std::int64_t{pixel} + 1) * cells / (2 * std::int64_t{size}));
}

int theta_h_cell(const SliceOptions& options, const Grid& grid, int x) {
  return options.axis == ThetaHAxis::kLinear ? theta_h_row_of_column(grid, x, options.size)
                                             : even_cell(x, options.size, grid.n_theta_h);
}

int theta_d_cell(const SliceOptions& options, const Grid& grid, int y) {
  return even_cell(options.size - 1 - y, options.size, grid.n_theta_d);
}

double theta_h_rad(const SliceOptions& options, const Grid& grid, int x) {
  if (options.sampling == SliceSampling::kStored) return grid.theta_h_rad(theta_h_cell(options, grid, x));
  const double place = (x + 0.5) / options.size;
  return (options.axis == ThetaHAxis::kLinear ? place : place * place) * kHalfPi;
}

double theta_d_rad(const SliceOptions& options, const Grid& grid, int y) {
  if (options.sampling == SliceSampling::kStored) return grid.theta_d_rad(theta_d_cell(options, grid, y));
  return (options.size - y - 0.5) / options.size * kHalfPi;
}

double phi_d_rad(const SliceOptions& options, const Grid& grid) {
  if (options.sampling == SliceSampling::kStored) {
    return grid.phi_d_rad(phi_d_index(grid, options.phi_d_deg));
  }
  const double folded_deg = options.phi_d_deg - 360.0 * std::floor(options.phi_d_deg / 360.0);
  // A tiny negative angle rounds up to the full turn.
  return folded_deg < 360.0 ? folded_deg / 180.0 * std::numbers::pi : 0.0;
}

// The samples along one side of the picture. Neighbouring pixels share one where they show the same stored
// angle.
struct Axis {
  std::vector<double> radians;
  std::vector<Angle> angle;
  std::vector<int> cell;         // of the grid
  std::vector<int> first_pixel;  // that shows it; the next sample's first pixel ends its run
  int pixels = 0;

  std::size_t size() const { return radians.size(); }
  int end_pixel(std::size_t sample) const { return sample + 1 < size() ? first_pixel[sample + 1] : pixels; }
  void add_pixel(double angle_rad, int its_cell, bool may_share) {
    if (!may_share || cell.empty() || cell.back() != its_cell) {
      radians.push_back(angle_rad);
      angle.emplace_back(angle_rad);
      cell.push_back(its_cell);
      first_pixel.push_back(pixels);
    }
    ++pixels;
  }
};

// Where the picture is sampled.
struct Samples {
  Axis columns;  // theta_h
  Axis rows;     // theta_d
  double phi_d_rad;
  double cos_phi_d;
  int phi_d_cell;

  Samples(const SliceOptions& options, const Grid& grid)
      : phi_d_rad(render::phi_d_rad(options, grid)),
        cos_phi_d(std::cos(phi_d_rad)),
        phi_d_cell(phi_d_index(grid, options.phi_d_deg)) {
    const bool stored = options.sampling == SliceSampling::kStored;
    for (int k = 0; k < options.size; ++k) {
      columns.add_pixel(theta_h_rad(options, grid, k), theta_h_cell(options, grid, k), stored);
      rows.add_pixel(theta_d_rad(options, grid, k), theta_d_cell(options, grid, k), stored);
    }
  }
};

// On the horizon itself the rounding of a cosine would decide what a pixel shows, and f may be without bound
// above it. MERL's files and the error measures draw the line at the same place.
double lowest_cosine() {
  return lowest_observed_cosine(90.0);
}

// Rows of a table's slice.
class TableRows {
 public:
  TableRows(const MeasuredTable& table, const Samples& samples, const SliceOptions& options)
      : table_(table), samples_(samples), options_(options) {}

  void operator()(std::size_t row, float* rgb, PixelState* state) const {
    for (std::size_t column = 0; column < samples_.columns.size(); ++column) {
      state[column] = draw(row, column, rgb + 3 * column);
    }
  }

 private:
  PixelState draw(std::size_t row, std::size_t column, float* rgb) const {
    const Angle& h = samples_.columns.angle[column];
    const Angle& d = samples_.rows.angle[row];
    const double along = d.cosine * h.cosine;
    const double across = d.sine * h.sine * samples_.cos_phi_d;
    if (along - std::abs(across) < lowest_cosine_) return PixelState::kBelowHorizon;
    const std::size_t cell =
        table_.grid().index(samples_.columns.cell[column], samples_.rows.cell[row], samples_.phi_d_cell);
    if (!table_.is_valid(cell)) return pixel_state_of(table_.state(cell));
    const double factor = options_.quantity == Quantity::kFCos ? along - across : 1.0;
    const Rgb f = value(row, column, cell);
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(f[c] * factor);
    return PixelState::kValue;
  }

  Rgb value(std::size_t row, std::size_t column, std::size_t cell) const {
    if (options_.sampling == SliceSampling::kStored) return table_.value(cell);
    const std::optional<Rgb> between = table_.interpolate(
        {samples_.columns.radians[column], samples_.rows.radians[row], samples_.phi_d_rad});
    // On an edge, rounding may have chosen a neighbour that was not measured.
    return between ? *between : table_.value(cell);
  }

  const MeasuredTable& table_;
  const Samples& samples_;
  const SliceOptions& options_;
  const double lowest_cosine_ = lowest_cosine();
};

constexpr std::size_t kChunk = simd::kBlock * 8;

// A stretch of a row on its way through vector code.
struct Chunk {
  std::array<double, kChunk> cos_i;
  std::array<double, kChunk> cos_o;
  // What depends on theta_d alone, repeated; or the horizontal components of the directions.
  std::array<std::array<double, kChunk>, 4> constant;
  std::array<std::array<double, kChunk>, 3> f;
};

// Rows of a material's slice. Trigonometry and logarithms are those of rows and columns; a pixel costs the
// model alone.
class MaterialRows {
 public:
  MaterialRows(const Material& material, const Samples& samples, const SliceOptions& options)
      : samples_(samples),
        quantity_(options.quantity),
        // Columns of geometry are isotropic; anisotropic masking asks for more.
        by_directions_(material.model() == Model::kBurley && material.effects().has(Effect::kAnisotropic)),
        coefficients_(simd::coefficients_of(material)),
        eval_columns_(simd::eval_columns(simd::best_isa())),
        eval_directions_(simd::eval_directions(simd::best_isa())) {
    const std::vector<Angle>& angles = samples.columns.angle;
    const std::size_t padded = (angles.size() + simd::kBlock - 1) / simd::kBlock * simd::kBlock;
    for (std::size_t k = 0; k < padded; ++k) {
      const Angle& h = angles[std::min(k, angles.size() - 1)];
      sin_h_.push_back(h.sine);
      cos_h_.push_back(h.cosine);
      one_minus_cos_h_.push_back(h.one_minus_cosine);
      log_cos_h_.push_back(h.log_cosine);
      log_one_minus_cos_h_.push_back(h.log_one_minus_cosine);
    }
  }

  void operator()(std::size_t row, float* rgb, PixelState* state) const {
    Chunk chunk;
    const Angle& d = samples_.rows.angle[row];
    if (!by_directions_) fill_constants(d, chunk);
    for (std::size_t first = 0; first < samples_.columns.size(); first += kChunk) {
      const std::size_t count = std::min(kChunk, samples_.columns.size() - first);
      evaluate(d, first, (count + simd::kBlock - 1) / simd::kBlock * simd::kBlock, chunk);
      store(chunk, count, rgb + 3 * first, state + first);
    }
  }

 private:
  static void fill_constants(const Angle& d, Chunk& chunk) {
    chunk.constant[0].fill(d.cosine);
    chunk.constant[1].fill(d.one_minus_cosine);
    chunk.constant[2].fill(d.log_cosine);
    chunk.constant[3].fill(d.log_one_minus_cosine);
  }

  // f cos_i of `padded` samples, and their cosines.
  void evaluate(const Angle& d, std::size_t first, std::size_t padded, Chunk& chunk) const {
    const double* sin_h = sin_h_.data() + first;
    const double* cos_h = cos_h_.data() + first;
    const double across_d = d.sine * samples_.cos_phi_d;
    for (std::size_t k = 0; k < padded; ++k) {
      const double along = d.cosine * cos_h[k];
      const double across = across_d * sin_h[k];
      chunk.cos_i[k] = along - across;
      chunk.cos_o[k] = along + across;
    }
    double* const out[3] = {chunk.f[0].data(), chunk.f[1].data(), chunk.f[2].data()};
    if (by_directions_) return evaluate_directions(d, first, padded, chunk, out);
    const auto& constant = chunk.constant;
    const simd::GeometryColumns columns = {chunk.cos_i.data(),
                                           chunk.cos_o.data(),
                                           sin_h,
                                           cos_h,
                                           constant[0].data(),
                                           one_minus_cos_h_.data() + first,
                                           constant[1].data(),
                                           log_cos_h_.data() + first,
                                           constant[2].data(),
                                           log_one_minus_cos_h_.data() + first,
                                           constant[3].data()};
    eval_columns_(coefficients_, columns, padded, out);
  }

  // As directions_from_half_diff.
  void evaluate_directions(const Angle& d, std::size_t first, std::size_t padded, Chunk& chunk,
                           double* const out[3]) const {
    auto& [wi_x, wi_y, wo_x, wo_y] = chunk.constant;
    const double a = d.sine * samples_.cos_phi_d;
    const double b = d.sine * std::sin(samples_.phi_d_rad);
    for (std::size_t k = 0; k < padded; ++k) {
      wi_x[k] = d.cosine * sin_h_[first + k] + a * cos_h_[first + k];
      wo_x[k] = d.cosine * sin_h_[first + k] - a * cos_h_[first + k];
      wi_y[k] = b;
      wo_y[k] = -b;
    }
    const simd::DirectionColumns directions = {wi_x.data(), wi_y.data(), chunk.cos_i.data(),
                                               wo_x.data(), wo_y.data(), chunk.cos_o.data()};
    eval_directions_(coefficients_, directions, padded, out);
  }

  void store(Chunk& chunk, std::size_t count, float* rgb, PixelState* state) const {
    const bool without_cosine = quantity_ == Quantity::kF;
    auto& [red, green, blue] = chunk.f;
    std::uint32_t all_finite = 1;
    for (std::size_t k = 0; k < count; ++k) {
      const double cos_i = chunk.cos_i[k];
      const bool above = std::min(cos_i, chunk.cos_o[k]) >= lowest_cosine_;
      const double factor = 1.0 / (without_cosine ? cos_i : 1.0);
      red[k] = above ? red[k] * factor : 0.0;
      green[k] = above ? green[k] * factor : 0.0;
      blue[k] = above ? blue[k] * factor : 0.0;
      all_finite &= std::uint32_t{fits_float(red[k])} & std::uint32_t{fits_float(green[k])} &
                    std::uint32_t{fits_float(blue[k])};
      state[k] = above ? PixelState::kValue : PixelState::kBelowHorizon;
    }
    if (all_finite == 0) drop_not_finite(chunk, count, state);
    for (std::size_t k = 0; k < count; ++k) {
      rgb[3 * k] = static_cast<float>(red[k]);
      rgb[3 * k + 1] = static_cast<float>(green[k]);
      rgb[3 * k + 2] = static_cast<float>(blue[k]);
    }
  }

  static bool fits_float(double value) { return value <= double{std::numeric_limits<float>::max()}; }

  static void drop_not_finite(Chunk& chunk, std::size_t count, PixelState* state) {
    for (std::size_t k = 0; k < count; ++k) {
      if (std::ranges::all_of(chunk.f, [k](const auto& channel) { return fits_float(channel[k]); })) continue;
      for (auto& channel : chunk.f) channel[k] = 0.0;
      state[k] = PixelState::kNotFinite;
    }
  }

  const Samples& samples_;
  const Quantity quantity_;
  const bool by_directions_;
  const double lowest_cosine_ = lowest_cosine();
  const simd::Coefficients coefficients_;
  const simd::EvalColumns eval_columns_;
  const simd::EvalDirections eval_directions_;
  // By column, padded.
  std::vector<double> sin_h_;
  std::vector<double> cos_h_;
  std::vector<double> one_minus_cos_h_;
  std::vector<double> log_cos_h_;
  std::vector<double> log_one_minus_cos_h_;
};

// One row of samples, and the row of pixels that it makes.
class RowOfPixels {
 public:
  explicit RowOfPixels(const Axis& columns)
      : columns_(columns),
        sample_rgb_(3 * columns.size()),
        sample_state_(columns.size()),
        rgb_(3 * static_cast<std::size_t>(columns.pixels)),
        state_(static_cast<std::size_t>(columns.pixels)) {}

  template <class Rows>
  void draw(const Rows& rows, std::size_t row) {
    std::ranges::fill(sample_rgb_, 0.0F);
    rows(row, sample_rgb_.data(), sample_state_.data());
    for (std::size_t sample = 0; sample < columns_.size(); ++sample) {
      for (int x = columns_.first_pixel[sample]; x < columns_.end_pixel(sample); ++x) {
        const auto pixel = static_cast<std::size_t>(x);
        std::copy_n(&sample_rgb_[3 * sample], 3, &rgb_[3 * pixel]);
        state_[pixel] = sample_state_[sample];
      }
    }
  }

  void copy_to(Image& image, int y) const {
    const std::size_t first = static_cast<std::size_t>(y) * state_.size();
    std::ranges::copy(rgb_, &image.rgb[3 * first]);
    std::ranges::copy(state_, &image.state[first]);
  }

 private:
  const Axis& columns_;
  std::vector<float> sample_rgb_;
  std::vector<PixelState> sample_state_;
  std::vector<float> rgb_;
  std::vector<PixelState> state_;
};

// A sample for every pixel: rows are drawn where they belong.
template <class Rows>
void draw_every_pixel(const Rows& rows, Image& image) {
  const auto width = static_cast<std::size_t>(image.width);
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      const auto row = static_cast<std::size_t>(y);
      rows(row, &image.rgb[3 * row * width], &image.state[row * width]);
    }
  });
}

template <class Rows>
void draw_shared_samples(const Rows& rows, const Samples& samples, Image& image) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.rows.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      RowOfPixels pixels(samples.columns);
                      for (std::size_t row = range.begin(); row < range.end(); ++row) {
                        pixels.draw(rows, row);
                        for (int y = samples.rows.first_pixel[row]; y < samples.rows.end_pixel(row); ++y) {
                          pixels.copy_to(image, y);
                        }
                      }
                    });
}

template <class Rows>
Image draw(const Rows& rows, const Samples& samples, const SliceOptions& options) {
  Image image(options.size, options.size);
  if (options.sampling == SliceSampling::kSmooth) {
    draw_every_pixel(rows, image);
  } else {
    draw_shared_samples(rows, samples, image);
  }
  return image;
}

bool has_sound_dimensions(const Grid& grid) {
  const auto sound = [](int count) { return count >= 1 && count <= kLargestDimension; };
  return sound(grid.n_theta_h) && sound(grid.n_theta_d) && sound(grid.n_phi_d);
}

}  // namespace

bool SliceOptions::is_valid(std::string* why) const {
  const auto fails = [why](const std::string& reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (size < 1 || size > kLargestSize) {
    return fails("size is " + std::to_string(size) + ", expected 1 to " + std::to_string(kLargestSize));
  }
  if (!std::isfinite(phi_d_deg)) return fails("phi_d is not a finite number of degrees");
  if (!has_sound_dimensions(grid)) {
    return fails("the grid has a dimension outside 1 to " + std::to_string(kLargestDimension));
  }
  return true;
}

HalfDiff slice_angles(const SliceOptions& options, int x, int y) {
  return {theta_h_rad(options, options.grid, x), theta_d_rad(options, options.grid, y),
          phi_d_rad(options, options.grid)};
}

Image draw_slice(const Subject& subject, const SliceOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("draw_slice: " + why);
  const MeasuredTable* table = subject.table();
  if (table != nullptr && table->plane(0).empty()) throw std::invalid_argument("draw_slice: an empty table");
  const Samples samples(options, grid_of(subject, options));
  if (table != nullptr) return draw(TableRows(*table, samples, options), samples, options);
  return draw(MaterialRows(*subject.material(), samples, options), samples, options);
}

}  // namespace brdfit::render

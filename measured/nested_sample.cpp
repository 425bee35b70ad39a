// Boxes that are halved again and again.
#include "measured/nested_sample.h"

#include <algorithm>
#include <cmath>

namespace brdfit {
namespace {

// Of the valid cells, for the check.
constexpr std::size_t kMostChecked = 8;

}  // namespace

NestedSample::NestedSample(const MeasuredTable& table, const Options& options)
    : table_(table),
      geometry_(table.grid()),
      min_cosine_(lowest_observed_cosine(options.sampling.max_theta_deg)),
      random_(options.seed) {
  check_ = boxes_for(std::min(options.check_cells, table.valid_count() / kMostChecked));
  for (const Box& box : check_) {
    if (box.counts) check_cells_.push_back(table.grid().index(box.theta_h, box.drawn_d, box.drawn_p));
  }
  std::ranges::sort(check_cells_);
  boxes_ = boxes_for(options.least);
  observed_ = count_of(boxes_);
  // Where much of what is valid is not observed.
  while (observed_ < options.least / 2 && grow()) {
  }
}

bool NestedSample::is_observed(const Box& box) const {
  const std::size_t cell = table_.grid().index(box.theta_h, box.drawn_d, box.drawn_p);
  if (!table_.is_valid(cell) || std::ranges::binary_search(check_cells_, cell)) return false;
  const PhiRun run = geometry_.observed(box.theta_h, box.drawn_d, min_cosine_);
  return box.drawn_p >= run.first && box.drawn_p < run.end;
}

void NestedSample::draw(Box& box) {
  const auto among = [&](int first, int end) {
    return first + static_cast<int>(random_() % static_cast<std::uint64_t>(end - first));
  };
  box.drawn_d = among(box.first_d, box.end_d);
  box.drawn_p = among(box.first_p, box.end_p);
  box.counts = is_observed(box);
}

// Across its longer side, in the proportion in which `parts` are shared between the two; an odd one goes to
// the second.
std::pair<NestedSample::Box, NestedSample::Box> NestedSample::cut(const Box& box, int parts) {
  const int d = box.end_d - box.first_d;
  const int p = box.end_p - box.first_p;
  std::pair<Box, Box> halves = {box, box};
  const auto first_part = [&](int length) {
    return std::clamp((length * (parts / 2) + parts / 2) / parts, 1, length - 1);
  };
  if (p > d) {
    halves.first.end_p = halves.second.first_p = box.first_p + first_part(p);
  } else {
    halves.first.end_d = halves.second.first_d = box.first_d + first_part(d);
  }
  return halves;
}

void NestedSample::divide(const Box& box, int parts, Boxes& boxes) {
  if (parts <= 1 || box.cells() == 1) {
    boxes.push_back(box);
    draw(boxes.back());
    return;
  }
  const auto [first, second] = cut(box, parts);
  divide(first, parts / 2, boxes);
  divide(second, parts - parts / 2, boxes);
}

NestedSample::Boxes NestedSample::halved(const Boxes& boxes) {
  Boxes result;
  result.reserve(2 * boxes.size());
  for (const Box& box : boxes) {
    if (box.cells() == 1) {
      result.push_back(box);
      continue;
    }
    auto [first, second] = cut(box, 2);
    for (Box* half : {&first, &second}) {
      if (!half->holds(box.drawn_d, box.drawn_p)) draw(*half);
      result.push_back(*half);
    }
  }
  return result;
}

// In each row as many as it takes where all cells that are valid are observed.
NestedSample::Boxes NestedSample::boxes_for(std::size_t count) {
  const Grid& grid = table_.grid();
  const double valid_in_row = static_cast<double>(table_.valid_count()) / grid.n_theta_h;
  const int cells_in_row = grid.n_theta_d * grid.n_phi_d;
  const double share = valid_in_row / cells_in_row;
  const double wanted = static_cast<double>(count) / grid.n_theta_h / std::max(share, 1e-9);
  const int parts = static_cast<int>(std::clamp(std::round(wanted), 1.0, static_cast<double>(cells_in_row)));
  Boxes boxes;
  for (int h = 0; h < grid.n_theta_h; ++h) {
    divide({h, 0, grid.n_theta_d, 0, grid.n_phi_d, 0, 0, false}, parts, boxes);
  }
  return boxes;
}

std::size_t NestedSample::count_of(const Boxes& boxes) {
  return static_cast<std::size_t>(std::ranges::count_if(boxes, &Box::counts));
}

bool NestedSample::grow() {
  Boxes next = halved(boxes_);
  if (next.size() == boxes_.size()) return false;
  boxes_ = std::move(next);
  observed_ = count_of(boxes_);
  return true;
}

SampleSet NestedSample::observations(const Boxes& boxes, std::vector<std::size_t>* cells) const {
  const Grid& grid = table_.grid();
  SampleSet samples;
  samples.reserve(boxes.size());
  for (const Box& box : boxes) {
    if (!box.counts) continue;
    const std::size_t cell = grid.index(box.theta_h, box.drawn_d, box.drawn_p);
    samples.add(geometry_.cell(box.theta_h, box.drawn_d, box.drawn_p), table_.value(cell),
                static_cast<double>(box.cells()));
    if (cells != nullptr) cells->push_back(cell);
  }
  samples.finish();
  return samples;
}

SampleSet NestedSample::samples(std::vector<std::size_t>* cells) const {
  return observations(boxes_, cells);
}

SampleSet NestedSample::check(std::vector<std::size_t>* cells) const {
  return observations(check_, cells);
}

}  // namespace brdfit

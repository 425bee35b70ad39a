// Passes over a stack's rows, gathering pictures.
#include "cli/bake_pictures.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "bake/luminance.h"
#include "cli/bake_evidence.h"
#include "cli/picture_file.h"

namespace brdfit::cli {
namespace {

// Of --memory, what panels may hold between rows.
constexpr std::size_t kMemoryShare = 4;

double luminance(std::span<const float> planes, std::size_t count, std::size_t k) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    sum += bake::kLuminance[c] * static_cast<double>(planes[c * count + k]);
  }
  return sum;
}

std::vector<std::string> names_of(const StackInfo& info) {
  std::vector<std::string> names;
  for (const StackLight& light : info.lights) names.push_back(light.name);
  return names;
}

render::Image blank_image(const TexelGrid& grid) {
  render::Image image(grid.width, grid.height);
  std::fill(image.state.begin(), image.state.end(), render::PixelState::kValue);
  return image;
}

render::Difference blank_difference(const TexelGrid& grid) {
  render::Difference difference;
  difference.width = grid.width;
  difference.height = grid.height;
  difference.value.assign(grid.count(), 0.0F);
  difference.state.assign(grid.count(), render::PixelState::kUnmeasured);
  return difference;
}

std::size_t bytes_of(const TexelGrid& grid, std::size_t differences) {
  constexpr std::size_t kImage = 3 * sizeof(float) + sizeof(render::PixelState);
  constexpr std::size_t kDifference = sizeof(float) + sizeof(render::PixelState);
  return grid.count() * (3 * kImage + differences * kDifference);
}

}  // namespace

BakePictures::BakePictures(const BakeArguments& a, const StackInfo& info, const bake::BakeSettings& settings,
                           std::string asset_name)
    : a_(a),
      info_(info),
      settings_(settings),
      name_(std::move(asset_name)),
      asked_(a.panels),
      grid_(info.width, info.height),
      folds_(bake::fold_count(info.lights.size(), a.folds)) {
  if (asked_.empty() && !a.no_panels && !a.no_evidence) asked_ = {"worst", "median", "best"};
  if (folds_ < 2) {
    if (!a.panels.empty()) throw UsageError("--panels: lights are held out in two folds at least");
    asked_.clear();
  }
  // What is wrong with them is said before anything is read.
  const std::vector<double> any(a.no_evidence ? 0 : info.lights.size());
  panel_lights(asked_, names_of(info), any);
}

std::filesystem::path BakePictures::folder() const {
  return std::filesystem::path(a_.output) / (name_ + ".panels");
}

void BakePictures::keep(int fold, bake::FoldPlans plans) {
  plans_.erase(fold);
  plans_.emplace(fold, Fold{std::move(plans), bake::held_out_lights(info_.lights.size(), fold, folds_), {}});
}

void BakePictures::prepare(const TexelBlock& sample, const bake::Evidence* evidence) {
  const bake::MethodEvidence* realis = evidence != nullptr ? evidence->find("realis") : nullptr;
  const std::vector<double> none;
  panels_ = panel_lights(asked_, names_of(info_), realis != nullptr ? realis->held_out.per_light_255 : none);
  for (const PanelLight& panel : panels_) {
    prepare_output(folder() / panel.file, a_.common.force);
    const int fold = static_cast<int>(panel.light) % folds_;
    if (!plans_.contains(fold)) {
      keep(fold,
           bake::plan_fold(info_, sample, fold, folds_, settings_, bake::EvidenceOptions{}.other_lobes));
    }
  }
  prepare_output(std::filesystem::path(a_.output) / (name_ + ".benefit.png"), a_.common.force);
  for (auto& [index, fold] : plans_) {
    const int number = index;
    const bool has_panel = std::any_of(panels_.begin(), panels_.end(), [&](const PanelLight& panel) {
      return static_cast<int>(panel.light) % folds_ == number;
    });
    // Every size is as much work again as all lights of the map: for those who ask for a light.
    fold.baker.emplace(info_, sample, fold.plans, settings_, has_panel && !a_.panels.empty(), !a_.no_dither);
  }
  benefit_.emplace(grid_);
  for (const auto& [index, fold] : plans_) benefit_->lights += fold.lights.size();
  begin_pass(0);
}

std::size_t BakePictures::panels_at_once() const {
  constexpr std::size_t kMostDifferences = 8;
  const std::size_t memory = (static_cast<std::size_t>(a_.memory_mib) << 20) / kMemoryShare;
  return std::max<std::size_t>(1, memory / bytes_of(grid_, kMostDifferences));
}

void BakePictures::begin_pass(std::size_t first) {
  now_.clear();
  next_ = std::min(panels_.size(), first + panels_at_once());
  for (std::size_t k = first; k < next_; ++k) {
    const PanelLight& choice = panels_[k];
    const int number = static_cast<int>(choice.light) % folds_;
    const Fold& fold = plans_.at(number);
    HeldOutPanel panel;
    panel.asset = name_;
    panel.light = info_.lights[choice.light];
    panel.words = choice.words;
    panel.model = title_of(fold.plans.plan.base);
    panel.fold = number;
    panel.folds = folds_;
    panel.held_out = fold.lights.size();
    panel.lobes = fold.baker->lobes();
    panel.kinds = fold.baker->others();
    panel.capture = panel.model_picture = panel.realis_picture = blank_image(grid_);
    panel.model_error = panel.realis_error = blank_difference(grid_);
    panel.others.assign(panel.kinds.size(), panel.model_error);
    now_.emplace(choice.light, Gathering{&choice, std::move(panel)});
  }
}

TexelBlock BakePictures::on_grid(const TexelBlock& strip) const {
  const auto width = static_cast<std::uint32_t>(info_.width);
  const auto step = static_cast<std::uint32_t>(grid_.step);
  std::vector<std::uint32_t> places;
  for (std::uint32_t k = 0; k < strip.count(); ++k) {
    const std::uint32_t texel = strip.texels[k];
    if ((texel % width) % step == 0 && (texel / width) % step == 0) places.push_back(k);
  }
  return bake::chosen_texels(strip, places);
}

void BakePictures::add(const TexelBlock& strip) {
  TexelBlock chosen;
  if (grid_.step > 1) chosen = on_grid(strip);
  const TexelBlock& block = grid_.step > 1 ? chosen : strip;
  if (block.count() == 0) return;
  for (const auto& [index, fold] : plans_) {
    const bool is_needed = benefit_ || std::any_of(fold.lights.begin(), fold.lights.end(),
                                                   [&](std::uint32_t light) { return now_.contains(light); });
    if (!is_needed) continue;
    const bake::HeldOutTexels texels = fold.baker->bake(block);
    for (const std::uint32_t light : fold.lights) {
      if (benefit_ || now_.contains(light)) add_light(light, texels, block);
    }
  }
}

// One light's share of a block, to its panel and to the map.
void BakePictures::add_light(std::uint32_t light, const bake::HeldOutTexels& texels,
                             const TexelBlock& block) {
  const auto gathered = now_.find(light);
  HeldOutPanel* panel = gathered != now_.end() ? &gathered->second.panel : nullptr;
  const bake::LightPrediction predicted = texels.predict(light, panel != nullptr);
  const std::size_t count = block.count();
  const auto capture = std::span(block.rgb).subspan(light * 3 * count, 3 * count);
  const auto width = static_cast<std::size_t>(info_.width);
  const auto step = static_cast<std::size_t>(grid_.step);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t texel = block.texels[k];
    const std::size_t at =
        (texel / width / step) * static_cast<std::size_t>(grid_.width) + texel % width / step;
    const double truth = luminance(capture, count, k);
    const bool counts = block.weight_of(light, k) != 0.0F;
    const auto error_of = [&](std::span<const float> planes) { return luminance(planes, count, k) - truth; };
    if (benefit_ && counts) {
      benefit_->without[at] += std::pow(error_of(predicted.model), 2);
      benefit_->with[at] += std::pow(error_of(predicted.realis), 2);
      ++benefit_->seen[at];
      if (texels.is_corrected(k)) benefit_->is_corrected[at] = 1;
    }
    if (panel == nullptr) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      panel->capture.rgb[3 * at + c] = capture[c * count + k];
      panel->model_picture.rgb[3 * at + c] = predicted.model[c * count + k];
      panel->realis_picture.rgb[3 * at + c] = predicted.realis[c * count + k];
    }
    if (!counts) continue;
    const auto put = [&](render::Difference& to, std::span<const float> planes) {
      to.value[at] = static_cast<float>(255.0 * error_of(planes));
      to.state[at] = render::PixelState::kValue;
    };
    put(panel->model_error, predicted.model);
    put(panel->realis_error, predicted.realis);
    for (std::size_t other = 0; other < panel->others.size(); ++other) {
      put(panel->others[other], predicted.others[other]);
    }
  }
}

void BakePictures::write_pass() {
  // Compressing takes longer than drawing, and each picture is by itself.
  tbb::task_group writing;
  const auto write = [&](const std::filesystem::path& file, render::Picture picture) {
    writing.run([file, kept = std::make_shared<const render::Picture>(std::move(picture))] {
      write_picture(file, *kept, {});
    });
  };
  if (benefit_) {
    const std::string file = name_ + ".benefit.png";
    DrawnPanel drawn = draw_benefit(*benefit_, name_, info_.lights.size(), grid_);
    write(std::filesystem::path(a_.output) / file, std::move(drawn.picture));
    json_["step"] = grid_.step;
    json_["tile"] = {grid_.enlargement * grid_.width, grid_.enlargement * grid_.height};
    json_["benefit"] = std::move(drawn.facts);
    json_["benefit"]["file"] = file;
    json_["panels"] = io::Json::array();
    benefit_.reset();
  }
  for (const auto& [light, gathered] : now_) {
    const HeldOutPanel& panel = gathered.panel;
    DrawnPanel drawn = draw_held_out_panel(panel, grid_);
    write(folder() / gathered.choice->file, std::move(drawn.picture));
    io::Json facts = {{"file", name_ + ".panels/" + gathered.choice->file},
                      {"light", panel.light.name},
                      {"place", light},
                      {"fold", panel.fold},
                      {"chosen_as", panel.words}};
    facts.update(drawn.facts);
    json_["panels"].push_back(std::move(facts));
  }
  writing.wait();
}

void BakePictures::finish(ImageStack& stack, int strip_rows,
                          const std::function<void()>& check_interruption) {
  write_pass();
  while (next_ < panels_.size()) {
    begin_pass(next_);
    for (int row = 0; row < info_.height; row += strip_rows) {
      check_interruption();
      TexelBlock block = stack.read_rows(row, std::min(strip_rows, info_.height - row));
      add(block);
      stack.give_back(std::move(block));
    }
    write_pass();
  }
}

}  // namespace brdfit::cli

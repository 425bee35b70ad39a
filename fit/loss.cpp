// Names and targets of losses.
#include "fit/loss.h"

#include <array>

#include "fit/loss_kernel.h"

namespace brdfit::fit {
namespace {

constexpr std::array kLosses = {Loss::kLogRatio, Loss::kCubeRoot, Loss::kLinear, Loss::kSrgb, Loss::kSlice};

static_assert(static_cast<int>(Loss::kLogRatio) == BRDFIT_LOSS_LOG_RATIO);
static_assert(static_cast<int>(Loss::kCubeRoot) == BRDFIT_LOSS_CUBE_ROOT);
static_assert(static_cast<int>(Loss::kLinear) == BRDFIT_LOSS_LINEAR);
static_assert(static_cast<int>(Loss::kSrgb) == BRDFIT_LOSS_SRGB);
static_assert(static_cast<int>(Loss::kSlice) == BRDFIT_LOSS_SLICE);

}  // namespace

std::string_view name_of(Loss loss) {
  switch (loss) {
    case Loss::kLogRatio:
      return "log-ratio";
    case Loss::kCubeRoot:
      return "cube-root";
    case Loss::kLinear:
      return "linear";
    case Loss::kSrgb:
      return "srgb";
    case Loss::kSlice:
      return "slice";
  }
  return "";
}

std::optional<Loss> loss_by_name(std::string_view name) {
  for (const Loss loss : kLosses) {
    if (name_of(loss) == name) return loss;
  }
  return std::nullopt;
}

std::span<const Loss> all_losses() {
  return kLosses;
}

LossShape shape_of(Loss loss) {
  if (loss == Loss::kLogRatio) return {.robust_width = 0.05, .clipped_share = 1.9, .clipped_width = 0.3};
  return {};
}

double loss_target(Loss loss, double f, double cos_i) {
  return transform(static_cast<int>(loss), f * cos_i, cos_i).value;
}

}  // namespace brdfit::fit

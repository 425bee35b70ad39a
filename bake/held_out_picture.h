// Pictures of texels under lights that took no part in their bake.
#ifndef BRDFIT_BAKE_HELD_OUT_PICTURE_H_
#define BRDFIT_BAKE_HELD_OUT_PICTURE_H_

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/evidence.h"
#include "bake/plan.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// Plans without the lights of fold `fold` of `folds`, with other numbers of lobes too: what evaluate() hands
// over. Throws as plan_bake, and std::invalid_argument where no light would be left.
FoldPlans plan_fold(const StackInfo& info, const TexelBlock& sample, int fold, int folds,
                    const BakeSettings& settings, std::span<const int> other_lobes);

// Texels under one light, linear, [channel][texel]. With Realis values may be negative.
struct LightPrediction {
  std::vector<float> model;                // the base model's render alone
  std::vector<float> realis;               // corrected
  std::vector<std::vector<float>> others;  // corrected by less, as HeldOutBaker::others()
};

// Texels baked by the plans of a fold: surface, amplitudes and which texels are corrected come from the
// fold's training lights alone.
class HeldOutTexels {
 public:
  ~HeldOutTexels();
  HeldOutTexels(HeldOutTexels&&) noexcept;
  // light: of the stack. What the pictures show under it is not looked at; its intensity is as stated.
  // with_others: LightPrediction::others is filled.
  LightPrediction predict(std::uint32_t light, bool with_others) const;
  // Whether the texel has amplitudes at all.
  bool is_corrected(std::size_t texel) const;

 private:
  friend class HeldOutBaker;
  struct State;
  explicit HeldOutTexels(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// Bakes blocks by the plans of a fold, in the colours of the settings. Refers to info, plans and settings.
class HeldOutBaker {
 public:
  // with_others: also Realis with the other numbers of lobes, with fewer bits and with fewer lobes per texel,
  // as evaluate() does; sample: the texels that decide what codes stand for.
  HeldOutBaker(const StackInfo& info, const TexelBlock& sample, const FoldPlans& plans,
               const BakeSettings& settings, bool with_others, bool dither);
  ~HeldOutBaker();
  HeldOutBaker(HeldOutBaker&&) noexcept;

  // What LightPrediction::others holds, in that order: other numbers of lobes first. Without those whose plan
  // has no lobes that help.
  const std::vector<RealisKind>& others() const;
  // Lobes of the plan; 0 where none help.
  int lobes() const;
  // block: of the stack, with all its lights, of which only the plan's are looked at.
  HeldOutTexels bake(const TexelBlock& block) const;

 private:
  friend class HeldOutTexels;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_HELD_OUT_PICTURE_H_

// What a bake is worth: errors of Lambert, of the fitted model, of other ways to relight, and of Realis,
// under lights that were baked from and under lights that were held out of everything.
#ifndef BRDFIT_BAKE_EVIDENCE_H_
#define BRDFIT_BAKE_EVIDENCE_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bake/compare_methods.h"
#include "bake/plan.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// What was planned without the lights of a fold.
struct FoldPlans {
  BakePlan plan;
  std::map<int, BakePlan> other_lobes;  // the same base with other numbers of lobes, by that number
};

// From a plan with BakePlan::also.
FoldPlans fold_plans(BakePlan plan);

// What a fold adds to the evidence.
struct FoldEvidence {
  BakePlan plan;
  std::vector<MethodSums> sums;
};

struct EvidenceOptions {
  int folds = 0;                         // 0: each light by itself up to 24 lights, else folds of about ten
  std::vector<int> other_lobes{4};       // Realis with these numbers of lobes too
  bool compressed = true;                // with 8 and 4 bits, and with half of the lobes per texel
  bool dither = true;                    // of what is rounded
  std::function<void(double)> progress;  // the share that is done, in [0, 1]; may be empty
  // Gives a fold, by make() or as make() gave it before; may be empty. For bakes that were interrupted.
  std::function<FoldEvidence(int fold, const std::function<FoldEvidence()>& make)> fold_of;
  std::function<void()> check;  // called between steps; may throw to stop. May be empty
  std::function<void(int fold, FoldPlans plans)> on_fold;  // takes a fold's plans; may be empty
};

struct Evidence {
  int folds = 0;
  std::size_t texels = 0;  // looked at
  std::vector<MethodEvidence> methods;
  const MethodEvidence* find(const std::string& name) const;
};

// Settings with which a plan holds all lobes that the evidence compares.
BakeSettings with_compared_lobes(BakeSettings settings, const EvidenceOptions& options);

// For every fold everything is planned and baked without its lights: normals, albedo, gains, material, lobes,
// ridge and which texels are corrected; a held-out light has its manifest intensity. sample: texels with all
// lights. plan: that of all lights, for the training errors. What is compared: compare_methods.
Evidence evaluate(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
                  const BakeSettings& settings, const EvidenceOptions& options = {});

// Fold f of count: lights f, f + count, f + 2 count, ...: neighbours of a spiral are in different folds.
LightChoice held_out_lights(std::size_t lights, int fold, int count);
int fold_count(std::size_t lights, int asked);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_EVIDENCE_H_

// The ways to relight a stack: what each of them misses under some of its lights.
#ifndef BRDFIT_BAKE_COMPARE_METHODS_H_
#define BRDFIT_BAKE_COMPARE_METHODS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/compress_block.h"
#include "bake/error_sums.h"
#include "bake/plan.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// Under lights that were baked from, and under lights that were held out.
struct MethodErrors {
  StackErrors train;
  StackErrors held_out;
};

// One way to relight a stack.
struct MethodEvidence {
  // "lambert", "model", "ptm", "sh9", "sh9-residual", "realis", "realis-k4", "realis-8bit", ...; where colour
  // is baked also "realis-luminance": what the same lobes would do without it.
  std::string name;
  int lobes = 0;  // of Realis
  int dominant = 0;
  int bits = 0;  // 0: not rounded
  double bytes_per_texel = 0.0;
  StackErrors train;  // of luminance
  StackErrors held_out;
  std::optional<MethodErrors> rgb;  // of the three channels together; nothing where luminance alone is baked
};

// One method's squared errors under the lights of a fold.
struct MethodSums {
  std::string name;  // as MethodEvidence::name
  ErrorSums luminance;
  ErrorSums rgb;  // of values of all channels; empty where luminance alone is baked
};

// One size of Realis.
struct RealisKind {
  std::string name;  // as MethodEvidence::name
  int lobes = 0;
  CompressOptions options;
  RealisColour colour = RealisColour::kLuminance;
  bool is_whole() const { return options.bits == 0 && options.dominant == lobes; }
  double bytes_per_texel() const;
};
// `name` itself, not rounded; with `compressed` also with 8 and 4 bits, and with `kept` lobes per texel (at
// least 1; all, where there are fewer), by whose number these are called.
std::vector<RealisKind> realis_kinds(const std::string& name, int lobes, int kept, RealisColour colour,
                                     bool compressed, bool dither);
// Half of the lobes.
int half_of(int lobes);

struct MethodOptions {
  bool compressed = true;       // Realis with 8 and 4 bits, and with fewer lobes per texel, too
  int kept = 1;                 // so many of them: the same for plans that are compared, whatever their lobes
  bool dither = true;           // of what is rounded
  std::function<void()> check;  // called between steps; may throw to stop. May be empty
};

struct ComparedMethods {
  std::vector<MethodEvidence> methods;  // without errors
  std::vector<MethodSums> sums;         // of each
};

// Errors under `lights` of all ways, made from the lights of the plan alone. sample: texels with all lights
// of the stack. Realis corrects as the asset does at run time: with BakeSettings::colour its errors, of
// luminance too, are those of channels that were corrected by amplitudes of their own, or by those of
// luminance and the texel's chroma.
ComparedMethods compare_methods(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
                                const BakeSettings& settings, const MethodOptions& options,
                                const LightChoice& lights);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_COMPARE_METHODS_H_

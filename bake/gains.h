// Gains of lights: by how much each is brighter than its stated intensity, found from the values themselves.
#ifndef BRDFIT_BAKE_GAINS_H_
#define BRDFIT_BAKE_GAINS_H_

#include <string>
#include <string_view>
#include <vector>

#include "bake/base_model.h"
#include "bake/chunk.h"
#include "bake/photometric_stereo.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

struct GainOptions {
  int rounds = 20;
  // Stops when no gain changes by more than this share of it.
  double tolerance = 1e-5;
  // Normals must spread by at least this (standard deviation of slopes, in every direction): a flat sample's
  // gains cannot be told from its tilt and its highlight.
  double least_spread = 0.1;
  StereoOptions stereo;
  // What values are compared with; Lambert unless it has a material.
  BaseModel model;

  bool is_valid(std::string* why) const;
};

enum class GainState {
  kOk,
  kUnsure,   // not told from 1: the gain is 1
  kNotSeen,  // too few normals face the light, or it was not among the lights given: the gain is 1
};
std::string_view name_of(GainState state);

// Per light of the stack.
struct GainEstimate {
  std::vector<double> gain;            // what the stated intensity is multiplied by; 1 where not found
  std::vector<double> standard_error;  // of the ratio before it was drawn towards 1; 0 where not seen
  std::vector<GainState> state;
  int rounds = 0;
  bool is_flat = false;  // normals spread too little: all gains are 1
};

// Alternates between normals and albedo for the gains at hand and, for each light, the ratio of values to the
// render that most normals agree on. The median gain is 1: a factor common to all lights is the albedo's.
//
// Normals are sorted into classes, each of which has its own ratio (a weighted median over its texels), and
// the spread of these ratios is the standard error: a wrong gain is the same for all classes, while shadows,
// highlights and interreflections differ. Gains within two standard errors of 1 are 1, and those near that
// are drawn towards it. Lights that are not among those given have gain 1, as held-out lights must. block: a
// sample of some hundred texels or more. Throws std::invalid_argument where sizes disagree.
GainEstimate estimate_gains(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                            const GainOptions& options = {});

// The stack with the intensities of its lights multiplied.
StackInfo with_gains(StackInfo info, const std::vector<double>& gains);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_GAINS_H_

// Lambert or a fitted material as the base model of a bake, by the error of lights held out.
#ifndef BRDFIT_BAKE_CHOOSE_BASE_H_
#define BRDFIT_BAKE_CHOOSE_BASE_H_

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/gains.h"
#include "bake/shared_material.h"

namespace brdfit::bake {

struct ChooseBaseOptions {
  // Models to try besides Lambert, simplest first.
  std::vector<Model> models = {Model::kLambertGgx, Model::kCallisto};
  int folds = 5;  // of lights, interleaved; at most one for each light
  // A model is taken only if its held-out error is lower than that of the best simpler one by this share,
  // lower in three of four folds, and lower in their mean by two standard errors.
  double margin = 0.01;
  StereoOptions stereo;
  SharedMaterialOptions material;  // but for its model, and its effects, which are all of the model's
  bool with_gains = false;         // estimate gains, anew in each fold
  GainOptions gains;
  std::function<void()> check;  // called between folds; may throw to stop. May be empty

  bool is_valid(std::string* why) const;
};

// One base model and its root-mean-square errors of luminance over the texels given.
struct BaseCandidate {
  std::optional<Model> model;  // Lambert where absent
  double training_rmse = 0.0;
  double held_out_rmse = 0.0;
  std::vector<double> fold_errors;  // squared errors, summed over the lights of each fold
};
std::string_view title_of(const BaseCandidate& candidate);

struct BaseChoice {
  std::vector<BaseCandidate> candidates;  // Lambert first
  std::size_t chosen = 0;
  SharedMaterial fit;  // of the chosen one, with all lights
  GainEstimate gains;  // with all lights; empty unless asked for
};

// Everything is redone in each fold without the lights held out: gains, normals, albedo, material, base
// colours; a light held out has its stated intensity. But of 30 lights or more materials start, in folds,
// where all of the lights given led to: for errors that are to be reported, hold lights out of `lights`.
// block: a sample of some hundred texels. Under fewer than 16 lights nothing is
// compared, and the choice is Lambert. Throws std::invalid_argument where sizes disagree or options are
// invalid.
BaseChoice choose_base_model(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                             const ChooseBaseOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CHOOSE_BASE_H_

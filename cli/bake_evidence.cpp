// Tables and JSON of what a bake found.
#include "cli/bake_evidence.h"

#include <fmt/format.h>

#include "io/material_json.h"

namespace brdfit::cli {
namespace {

// 0 where there was no error to begin with.
double relative(double error, double without) {
  return without > 0.0 ? error / without : 0.0;
}

io::Json gains_json(const bake::BakePlan& plan, const StackInfo& info) {
  io::Json json = io::Json::array();
  const bake::GainEstimate& estimate = *plan.gain_estimate;
  for (std::size_t k = 0; k < plan.lights.size(); ++k) {
    json.push_back({{"light", info.lights[plan.lights[k]].name},
                    {"gain", estimate.gain[k]},
                    {"standard_error", estimate.standard_error[k]},
                    {"state", bake::name_of(estimate.state[k])}});
  }
  return json;
}

// Squared errors over the sample under held-out lights, relative to that without lobes.
io::Json lobe_choice_json(const bake::LobeChoice& choice) {
  io::Json json;
  json["optimised"] = choice.optimised;
  json["candidates"] = io::Json::array();
  for (const bake::Candidate& candidate : choice.candidates) {
    json["candidates"].push_back({{"lobes", candidate.count},
                                  {"optimised", candidate.optimised},
                                  {"held_out_error", relative(candidate.error(), choice.error_without())}});
  }
  return json;
}

void add_errors(io::Json& json, const std::string& prefix, const bake::StackErrors& train,
                const bake::StackErrors& held_out) {
  json[prefix + "train_rmse_255"] = train.rmse_255;
  json[prefix + "held_out_rmse_255"] = held_out.rmse_255;
  json[prefix + "held_out_lit_rmse_255"] = held_out.lit_rmse_255;
  json[prefix + "worst_light_rmse_255"] = held_out.worst_light_rmse_255;
  json[prefix + "worst_light"] = held_out.worst_light;
  json[prefix + "train_psnr_db"] = train.psnr_db;
  json[prefix + "held_out_psnr_db"] = held_out.psnr_db;
  json[prefix + "held_out_per_light_255"] = held_out.per_light_255;
}

std::string heading(const std::string& title) {
  return fmt::format("{:<18} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9}  {}\n", title, "bytes", "train", "held out",
                     "lit", "PSNR dB", "worst", "under light");
}

std::string row(const bake::MethodEvidence& method, const bake::StackErrors& train,
                const bake::StackErrors& held_out, const StackInfo& info) {
  const std::string bytes =
      method.lobes > 0 && method.bits > 0 ? fmt::format("{:.1f}", method.bytes_per_texel) : "";
  return fmt::format("{:<18} {:>6} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f}  {}\n", method.name, bytes,
                     train.rmse_255, held_out.rmse_255, held_out.lit_rmse_255, held_out.psnr_db,
                     held_out.worst_light_rmse_255, info.lights[held_out.worst_light].name);
}

}  // namespace

std::string title_of(const bake::BaseModel& base) {
  return base.material ? std::string(title_of(base.material->model())) : "Lambert";
}

io::Json evidence_json(const bake::Evidence& evidence) {
  io::Json json = io::Json::object();
  for (const bake::MethodEvidence& method : evidence.methods) {
    io::Json one;
    add_errors(one, "", method.train, method.held_out);
    if (method.lobes > 0) {
      one["lobes"] = method.lobes;
      one["dominant"] = method.dominant;
      one["bits"] = method.bits;
      one["bytes_per_texel"] = method.bytes_per_texel;
    }
    if (method.rgb) add_errors(one, "rgb_", method.rgb->train, method.rgb->held_out);
    json[method.name] = std::move(one);
  }
  return json;
}

io::Json plan_json(const bake::BakePlan& plan, const StackInfo& info) {
  io::Json json;
  json["base"] = plan.base.material ? io::material_to_json(*plan.base.material) : io::Json("lambert");
  if (!plan.candidates.empty()) {
    json["base_candidates"] = io::Json::array();
    for (const bake::BaseCandidate& candidate : plan.candidates) {
      json["base_candidates"].push_back({{"model", bake::title_of(candidate)},
                                         {"training_rmse_255", 255.0 * candidate.training_rmse},
                                         {"held_out_rmse_255", 255.0 * candidate.held_out_rmse}});
    }
  }
  if (plan.gain_estimate) json["gains"] = gains_json(plan, info);
  json["lobes"] = plan.system ? plan.system->lobes().size() : 0;
  if (plan.system) json["ridge"] = plan.system->ridge();
  if (plan.lobe_choice) json["lobe_choice"] = lobe_choice_json(*plan.lobe_choice);
  json["warnings"] = io::Json::array();
  for (const bake::SolveWarning& warning : plan.warnings) {
    json["warnings"].push_back({{"name", warning.name}, {"message", warning.message}});
  }
  return json;
}

std::string evidence_text(const bake::Evidence& evidence, const StackInfo& info) {
  std::string text = heading("RMSE in 1/255");
  bool has_rgb = false;
  for (const bake::MethodEvidence& m : evidence.methods) {
    text += row(m, m.train, m.held_out, info);
    has_rgb = has_rgb || m.rgb;
  }
  if (has_rgb) text += heading("RGB RMSE in 1/255");
  for (const bake::MethodEvidence& m : evidence.methods) {
    if (m.rgb) text += row(m, m.rgb->train, m.rgb->held_out, info);
  }
  text += fmt::format("held out: {} folds over {} lights, everything redone in each; {} texels\n",
                      evidence.folds, info.lights.size(), evidence.texels);
  return text;
}

std::string plan_text(const bake::BakePlan& plan, const StackInfo& info) {
  std::string text = "base model: " + title_of(plan.base);
  for (const bake::BaseCandidate& candidate : plan.candidates) {
    text += fmt::format("{} {} {:.2f}", &candidate == plan.candidates.data() ? " (held out, 1/255:" : ",",
                        bake::title_of(candidate), 255.0 * candidate.held_out_rmse);
  }
  text += plan.candidates.empty() ? "\n" : ")\n";
  if (plan.system) {
    text += fmt::format("lobes: {}, {}; ridge {:.3g}\n", plan.system->lobes().size(),
                        !plan.lobe_choice             ? "as given"
                        : plan.lobe_choice->optimised ? "optimised"
                                                      : "uniform",
                        plan.system->ridge());
  }
  if (plan.gain_estimate) {
    std::size_t found = 0;
    for (const double gain : plan.gains) found += gain != 1.0 ? 1 : 0;
    text +=
        fmt::format("gains: {} of {} lights differ from what the stack says\n", found, info.lights.size());
    for (std::size_t k = 0; k < plan.gains.size(); ++k) {
      if (plan.gains[k] != 1.0) text += fmt::format("  {}: {:.3f}\n", info.lights[k].name, plan.gains[k]);
    }
  }
  for (const bake::SolveWarning& warning : plan.warnings) {
    text += fmt::format("warning: {} ({})\n", warning.message, warning.name);
  }
  return text;
}

}  // namespace brdfit::cli

// The members of all that a plan and its evidence are made of.
#include "bake/plan_record.h"

#include <algorithm>
#include <utility>

#include "bake/record.h"

// Each in the namespace of its type, where archives find it.
namespace brdfit {

template <class Archive>
static void fields(Archive& a, Vec3& v) {
  a(v.x, v.y, v.z);
}

template <class Archive>
static void fields(Archive& a, Lobe& lobe) {
  a(lobe.axis, lobe.sharpness, lobe.cos_cut_off);
}

template <class Archive>
static void fields(Archive& a, RealisRange& range) {
  a(range.step, range.zero);
}

template <class Archive>
static void fields(Archive& a, Material& material) {
  Model model = material.model();
  a(model);
  if constexpr (Archive::kReads) material = Material(model);
  MaterialOptions& options = material.options();
  std::uint32_t effects = material.effects().bits();
  std::vector<double> values(material.values().begin(), material.values().end());
  a(options.masking, options.burley_g, options.diffuse, effects, values);
  if constexpr (Archive::kReads) {
    if (values.size() != material.values().size()) throw bake::BadRecord("a material has other parameters");
    material.set_effects(Effects(effects));
    std::ranges::copy(values, material.values().begin());
  }
}

namespace fit {

template <class Archive>
static void fields(Archive& a, ParameterState& state) {
  a(state.name, state.status, state.components, state.standard_error, state.reason);
}

}  // namespace fit

namespace bake {

template <class Archive>
static void fields(Archive& a, BaseModel& model) {
  a(model.material, model.robust_width);
}

template <class Archive>
static void fields(Archive& a, SharedMaterial& fit) {
  a(fit.model, fit.converged, fit.termination, fit.iterations, fit.texels, fit.rmse, fit.lambert_rmse,
    fit.parameters);
}

template <class Archive>
static void fields(Archive& a, GainEstimate& gains) {
  a(gains.gain, gains.standard_error, gains.state, gains.rounds, gains.is_flat);
}

template <class Archive>
static void fields(Archive& a, BaseCandidate& candidate) {
  a(candidate.model, candidate.training_rmse, candidate.held_out_rmse, candidate.fold_errors);
}

template <class Archive>
static void fields(Archive& a, Candidate& candidate) {
  a(candidate.count, candidate.optimised, candidate.errors);
}

template <class Archive>
static void fields(Archive& a, LobeSearchResult& search) {
  a(search.lobes, search.ridge, search.objective, search.start_objective, search.uniform, search.start,
    search.converged, search.evaluations);
}

template <class Archive>
static void fields(Archive& a, LobeChoice& choice) {
  a(choice.lobes, choice.ridge, choice.optimised, choice.squared_modulation, choice.search,
    choice.errors_without, choice.candidates);
}

// What it was made from; it is made from that anew.
static void fields(RecordWriter& a, LobeSystem& system) {
  LobeSet lobes = system.lobes();
  std::vector<Vec3> directions = system.directions();
  std::vector<double> squares = system.squared_modulation();
  double ridge = system.ridge();
  a(lobes, directions, squares, ridge);
}

static void read_into(RecordReader& a, std::optional<LobeSystem>& system) {
  LobeSet lobes;
  std::vector<Vec3> directions;
  std::vector<double> squares;
  double ridge = 0.0;
  a(lobes, directions, squares, ridge);
  system.emplace(std::move(lobes), directions, squares, ridge);
}

template <class Archive>
static void fields(Archive& a, SolveWarning& warning) {
  a(warning.name, warning.message);
}

template <class Archive>
static void fields(Archive& a, BakePlan& plan) {
  a(plan.lights, plan.gains, plan.gain_estimate, plan.base, plan.material, plan.candidates, plan.system,
    plan.also, plan.lobe_choice, plan.warnings);
}

template <class Archive>
static void fields(Archive& a, StackErrors& errors) {
  a(errors.rmse_255, errors.psnr_db, errors.lit_rmse_255, errors.worst_light_rmse_255, errors.worst_light,
    errors.per_light_255);
}

template <class Archive>
static void fields(Archive& a, MethodErrors& errors) {
  a(errors.train, errors.held_out);
}

template <class Archive>
static void fields(Archive& a, MethodEvidence& method) {
  a(method.name, method.lobes, method.dominant, method.bits, method.bytes_per_texel, method.train,
    method.held_out, method.rgb);
}

template <class Archive>
static void fields(Archive& a, ErrorSums& sums) {
  a(sums.squares, sums.counts, sums.lit_squares, sums.lit_count);
}

template <class Archive>
static void fields(Archive& a, MethodSums& sums) {
  a(sums.name, sums.luminance, sums.rgb);
}

template <class Archive>
static void fields(Archive& a, FoldEvidence& fold) {
  a(fold.plan, fold.sums);
}

template <class Archive>
static void fields(Archive& a, Evidence& evidence) {
  a(evidence.folds, evidence.texels, evidence.methods);
}

namespace {

template <class Value>
std::vector<std::byte> record_of(Value value) {
  RecordWriter writer;
  writer(value);
  return writer.bytes();
}

template <class Value>
Value value_of(std::span<const std::byte> bytes) {
  Value value;
  RecordReader reader(bytes);
  reader(value);
  reader.finish();
  return value;
}

}  // namespace

std::vector<std::byte> plan_record(BakePlan plan) {
  return record_of(std::move(plan));
}
std::vector<std::byte> fold_record(FoldEvidence fold) {
  return record_of(std::move(fold));
}
std::vector<std::byte> evidence_record(Evidence evidence) {
  return record_of(std::move(evidence));
}
std::vector<std::byte> ranges_record(std::vector<RealisRange> ranges) {
  return record_of(std::move(ranges));
}

BakePlan plan_of_record(std::span<const std::byte> bytes) {
  return value_of<BakePlan>(bytes);
}
FoldEvidence fold_of_record(std::span<const std::byte> bytes) {
  return value_of<FoldEvidence>(bytes);
}
Evidence evidence_of_record(std::span<const std::byte> bytes) {
  return value_of<Evidence>(bytes);
}
std::vector<RealisRange> ranges_of_record(std::span<const std::byte> bytes) {
  return value_of<std::vector<RealisRange>>(bytes);
}

}  // namespace bake
}  // namespace brdfit

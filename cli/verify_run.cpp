// brdfit verify with the gpu room: device, parity, timings, and what is printed of them.
#include "cli/verify_run.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/picture_file.h"
#include "cli/verify_bake.h"
#include "cli/verify_pictures.h"
#include "gpu/material_pass.h"
#include "gpu/parity.h"
#include "gpu/timing.h"
#include "io/error.h"
#include "io/material_json.h"

namespace brdfit::cli {
namespace {

using io::Json;

constexpr std::array<std::string_view, 3> kChannels = {"red", "green", "blue"};

// What one run found.
struct Findings {
  Material material;
  std::string device;
  bool on_processor = false;
  ParityReport parity;
  std::vector<EffectTiming> timings;
};

std::vector<std::uint32_t> read_spirv(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::copy_n(bytes.data(), 4 * words.size(), reinterpret_cast<char*>(words.data()));
  constexpr std::uint32_t kMagic = 0x07230203;
  if (!stream || bytes.size() % 4 != 0 || words.empty() || words[0] != kMagic) {
    throw io::IoError(io::IoError::Side::kInput, file, "is not a SPIR-V module",
                      "compile one with glslc --target-env=vulkan1.1");
  }
  return words;
}

FloatPair pair_of(const std::vector<double>& numbers) {
  FloatPair pair;
  for (std::size_t k = 0; k < 3; ++k) {
    pair.wi[k] = static_cast<float>(numbers[k]);
    pair.wo[k] = static_cast<float>(numbers[k + 3]);
  }
  for (const auto& w : {pair.wi, pair.wo}) {
    const double length = std::hypot(double{w[0]}, double{w[1]}, double{w[2]});
    if (!(std::abs(length - 1.0) < 1e-5)) throw UsageError("--pair: a direction is not a unit vector");
  }
  return pair;
}

// The command that looks at the worst pair alone. Nine digits name a float.
std::string command_for(const VerifyRequest& request, const FloatPair& pair) {
  std::string command = fmt::format("brdfit verify {} --pair {:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                                    quoted_word(request.file), pair.wi[0], pair.wi[1], pair.wi[2], pair.wo[0],
                                    pair.wo[1], pair.wo[2]);
  if (!request.device.empty()) command += " --device " + quoted_word(request.device);
  if (!request.shader.empty()) command += " --shader " + quoted_word(request.shader);
  return command;
}

Findings find(const VerifyRequest& request, const DeviceRequest& device_request) {
  const Material material = io::read_material(request.file);
  const std::vector<std::uint32_t> shader =
      request.shader.empty() ? std::vector<std::uint32_t>() : read_spirv(request.shader);
  ComputeDevice device = ComputeDevice::open(device_request);
  MaterialPassOptions options;
  options.shader = shader;
  MaterialPass pass(device, options);
  const FloatEval on_device = [&](std::span<const FloatPair> pairs, std::span<FloatRgb> out) {
    pass.eval_cos(material, pairs, out);
  };
  const auto check = [&] {
    if (request.pair.empty()) return check_parity(material, on_device, {request.pairs, request.seed});
    const FloatPair pair = pair_of(request.pair);
    return check_parity(material, on_device, std::span(&pair, 1));
  };
  Findings findings{material, device.name(), device.is_processor(), check(), {}};
  if (request.timings) findings.timings = time_effects(pass, material);
  if (!request.picture.empty()) {
    write_picture(request.picture, verify_panel(material, base_name(request.file), device.name(), pass), {});
  }
  return findings;
}

Json percentiles_json(const LogHistogram& errors) {
  if (errors.count() == 0) return {{"count", 0}};
  return {{"count", errors.count()},          {"median", errors.percentile(0.5)},
          {"p90", errors.percentile(0.9)},    {"p99", errors.percentile(0.99)},
          {"p999", errors.percentile(0.999)}, {"max", errors.maximum()}};
}

// JSON has no infinity: null.
Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json comparison_json(const Comparison& comparison, const VerifyRequest& request) {
  const WorstPair& worst = comparison.worst;
  return {{"relative", percentiles_json(comparison.errors.relative())},
          {"ulp", percentiles_json(comparison.errors.ulp())},
          {"absolute", percentiles_json(comparison.errors.absolute())},
          {"over", comparison.errors.over()},
          {"not_finite", comparison.errors.not_finite()},
          {"worst",
           {{"wi", worst.pair.wi},
            {"wo", worst.pair.wo},
            {"channel", kChannels[static_cast<std::size_t>(worst.channel)]},
            {"reference", worst.reference},
            {"value", finite_or_null(static_cast<double>(worst.value))},
            {"share_of_allowed", finite_or_null(worst.share)},
            {"command", command_for(request, worst.pair)}}}};
}

Json timings_json(const std::vector<EffectTiming>& timings) {
  Json rows = Json::array();
  for (const EffectTiming& timing : timings) {
    rows.push_back({{"effects", timing.name},
                    {"device_ns", timing.device_ns ? Json(*timing.device_ns) : Json(nullptr)},
                    {"scalar_ns", timing.scalar_ns},
                    {"vector_ns", timing.vector_ns}});
  }
  return rows;
}

Json findings_json(const Findings& findings, const VerifyRequest& request) {
  const ParityReport& parity = findings.parity;
  Json json = {{"brdfit_verify", 1},
               {"file", request.file},
               {"model", name_of(findings.material.model())},
               {"device", findings.device},
               {"device_is_processor", findings.on_processor},
               {"pairs", parity.pairs},
               {"threshold",
                {{"bright", parity.threshold.bright},
                 {"relative", parity.threshold.relative},
                 {"absolute", parity.threshold.absolute}}},
               {"on_device", comparison_json(parity.device, request)},
               {"float_on_processor", comparison_json(parity.processor, request)},
               {"passed", parity.passed()}};
  if (request.pair.empty()) json["seed"] = request.seed;
  if (request.timings) json["timings"] = timings_json(findings.timings);
  return json;
}

void print_row(std::string_view name, const LogHistogram& device, const LogHistogram& processor) {
  for (const auto* errors : {&device, &processor}) {
    fmt::print("{:<22}{:<8}{:>10.2g}{:>10.2g}{:>10.2g}{:>10.2g}{:>10.2g}{:>12}\n", name,
               errors == &device ? "device" : "float", errors->percentile(0.5), errors->percentile(0.9),
               errors->percentile(0.99), errors->percentile(0.999), errors->maximum(), errors->count());
    name = "";
  }
}

void print_parity(const ParityReport& parity) {
  fmt::print("{:<30}{:>10}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "error against double", "median", "90%", "99%",
             "99.9%", "largest", "values");
  print_row("relative", parity.device.errors.relative(), parity.processor.errors.relative());
  print_row("  in ulps of float", parity.device.errors.ulp(), parity.processor.errors.ulp());
  print_row("absolute, of the rest", parity.device.errors.absolute(), parity.processor.errors.absolute());
}

void print_worst(const VerifyRequest& request, const ParityReport& parity) {
  const WorstPair& worst = parity.device.worst;
  fmt::print("worst: {:.9g} for {:.9g} ({}), {:.3g} of what is allowed\n", worst.value, worst.reference,
             kChannels[static_cast<std::size_t>(worst.channel)], worst.share);
  fmt::print("       {}\n", command_for(request, worst.pair));
  if (parity.passed()) {
    fmt::print("all {} values are within the threshold\n", 3 * parity.pairs);
  } else {
    fmt::print("{} of {} values are beyond the threshold, {} of them not finite\n",
               parity.device.errors.over(), 3 * parity.pairs, parity.device.errors.not_finite());
  }
}

void print_timings(const std::vector<EffectTiming>& timings) {
  fmt::print("\n{:<30}{:>10}{:>16}{:>17}\n", "ns per pair, by effects", "device", "1 thread, float",
             "vectors, double");
  for (const EffectTiming& timing : timings) {
    fmt::print("{:<30}{:>10}{:>16.1f}{:>17.1f}\n", timing.name,
               timing.device_ns ? fmt::format("{:.1f}", *timing.device_ns) : "no clock", timing.scalar_ns,
               timing.vector_ns);
  }
  if (timings.size() > 1 && timings.front().device_ns && timings.back().device_ns) {
    fmt::print("all effects take {:.2f} times as long as none on the device\n",
               *timings.back().device_ns / *timings.front().device_ns);
  }
}

void print_text(const Findings& findings, const VerifyRequest& request) {
  const ParityReport& parity = findings.parity;
  fmt::print("{} on {}{}, {} pairs\n", title_of(findings.material.model()), findings.device,
             findings.on_processor ? " (the processor)" : "", parity.pairs);
  fmt::print("allowed: {:.3g} relative where f cos_i > {:g}, {:g} absolute elsewhere\n\n",
             parity.threshold.relative, parity.threshold.bright, parity.threshold.absolute);
  print_parity(parity);
  fmt::print("\n");
  print_worst(request, parity);
  if (request.timings) print_timings(findings.timings);
}

int list_devices(bool json) {
  const std::vector<std::string> names = compute_device_names();
  if (json) {
    fmt::print("{}\n", Json{{"devices", names}}.dump(2));
    return kDone;
  }
  for (std::size_t k = 0; k < names.size(); ++k) fmt::print("{}: {}\n", k, names[k]);
  return kDone;
}

}  // namespace

int verify(const VerifyRequest& request) {
  if (request.list_devices) return list_devices(request.common.json);
  if (!request.picture.empty()) {
    if (picture_format_of(request.picture) != PictureFormat::kPng)
      throw UsageError("--picture " + request.picture + ": is drawn as PNG alone");
    if (is_baked_asset(request.file)) throw UsageError("--picture draws materials, not baked assets");
    prepare_output(request.picture, request.common.force);
  }
  std::uint64_t messages = 0;
  DeviceRequest device;
  device.device = request.device;
  if (request.validation) {
    device.on_validation_message = [&](const std::string& message) {
      ++messages;
      fmt::print(stderr, "validation: {}\n", message);
    };
  }
  if (is_baked_asset(request.file)) {
    ComputeDevice opened = ComputeDevice::open(device);
    const int code = verify_bake(request, opened);
    return messages > 0 ? static_cast<int>(kFailed) : code;
  }
  const Findings findings = find(request, device);
  if (request.common.json) {
    Json json = findings_json(findings, request);
    if (request.validation) json["validation_messages"] = messages;
    fmt::print("{}\n", json.dump(2));
  } else if (!request.common.quiet) {
    print_text(findings, request);
  }
  if (messages > 0) return kFailed;
  return findings.parity.passed() ? kDone : kNotAllDone;
}

}  // namespace brdfit::cli

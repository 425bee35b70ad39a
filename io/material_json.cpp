// Materials to JSON and back.
#include "io/material_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace brdfit::io {
namespace {

constexpr int kVersion = 1;
constexpr std::string_view kSrgbSuffix = "_srgb8";

bool has_srgb(const ParameterInfo& info) {
  return info.kind == Kind::kColour || info.kind == Kind::kTint;
}

std::string srgb_name(const ParameterInfo& info) {
  return fmt::format("{}{}", info.name, kSrgbSuffix);
}

std::span<const double> components(const Material& material, const ParameterInfo& info) {
  return material.values().subspan(static_cast<std::size_t>(info.offset),
                                   static_cast<std::size_t>(info.components));
}

Json parameters_to_json(const Material& material) {
  Json parameters = Json::object();
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!material.effects().has(info.effect)) continue;
    const auto values = components(material, info);
    const std::string name(info.name);
    if (info.components == 1) {
      parameters[name] = values[0];
      continue;
    }
    parameters[name] = std::vector<double>(values.begin(), values.end());
    if (!has_srgb(info)) continue;
    Json& srgb = parameters[srgb_name(info)] = Json::array();
    for (const double channel : values) srgb.push_back(srgb8_from_linear(channel));
  }
  return parameters;
}

Json effects_to_json(Effects effects) {
  Json names = Json::array();
  for (const Effect effect : all_effects()) {
    if (effects.has(effect)) names.push_back(effect_name(effect));
  }
  return names;
}

Json options_to_json(const Material& material) {
  const MaterialOptions& options = material.options();
  if (material.model() == Model::kBurley) return {{"burley_g", name_of(options.burley_g)}};
  return {{"masking", name_of(options.masking)}, {"diffuse", name_of(options.diffuse)}};
}

// A member that names one of a few things; absent, the fallback.
template <typename T>
T named(ObjectReader& reader, std::string_view key, std::optional<T> (*by_name)(std::string_view), T fallback,
        const char* expected) {
  const std::string name = reader.string(key, name_of(fallback));
  const std::optional<T> found = by_name(name);
  if (!found) reader.fail(key, fmt::format("is \"{}\"", name), expected);
  return *found;
}

MaterialOptions options_from_json(ObjectReader reader, Model model) {
  MaterialOptions options;
  if (model == Model::kBurley) {
    options.burley_g = named(reader, "burley_g", &burley_g_by_name, options.burley_g, "\"2012\" or \"2017\"");
  } else {
    options.masking =
        named(reader, "masking", &masking_by_name, options.masking, "\"separable\" or \"correlated\"");
    options.diffuse =
        named(reader, "diffuse", &diffuse_by_name, options.diffuse, "\"lambert\" or \"proxima\"");
  }
  reader.finish();
  return options;
}

Model model_from_json(ObjectReader& reader) {
  std::vector<std::string_view> names;
  for (const Model model : all_models()) names.push_back(name_of(model));
  const std::string name = reader.string("model");
  const std::optional<Model> model = model_by_name(name);
  if (!model) {
    reader.fail("model", fmt::format("is \"{}\"", name), fmt::format("one of {}", fmt::join(names, ", ")));
  }
  return *model;
}

Effects effects_from_json(ObjectReader& reader, Model model) {
  const Effects possible = effects_of(model);
  Effects effects;
  for (const std::string& name : reader.strings("effects")) {
    const std::optional<Effect> effect = effect_by_name(name);
    if (!effect || *effect == Effect::kNone || !possible.has(*effect)) {
      reader.fail("effects", fmt::format("names \"{}\"", name),
                  fmt::format("effects of {}: {}", name_of(model), effects_to_json(possible).dump()));
    }
    if (effects.has(*effect)) reader.fail("effects", fmt::format("names \"{}\" twice", name), "each once");
    effects = effects.with(*effect);
  }
  return effects;
}

double component_from_json(const ObjectReader& reader, const ParameterInfo& info, const Json& value) {
  const std::string expected = fmt::format("{} numbers in [{}, {}]", info.components, info.lower, info.upper);
  if (!value.is_number()) reader.fail(info.name, "holds " + value.dump(), expected);
  const double number = value.get<double>();
  if (!(number >= info.lower && number <= info.upper)) {
    reader.fail(info.name, "holds " + value.dump(), expected);
  }
  return number;
}

Rgb colour_from_json(ObjectReader& reader, const ParameterInfo& info) {
  const Json& value = reader.member(info.name);
  if (!value.is_array() || value.size() != 3) {
    reader.fail(info.name, value.is_array() ? fmt::format("has {} items", value.size()) : "is no array",
                fmt::format("3 numbers in [{}, {}]", info.lower, info.upper));
  }
  Rgb colour = {};
  for (std::size_t k = 0; k < 3; ++k) colour[k] = component_from_json(reader, info, value[k]);
  return colour;
}

// The triple is for people: the linear colour beside it is the one that counts.
void check_srgb(ObjectReader& reader, const ParameterInfo& info) {
  const std::string name = srgb_name(info);
  if (!reader.has(name)) return;
  const Json& value = reader.member(name);
  const auto is_code = [](const Json& item) {
    return item.is_number_integer() && item.get<double>() >= 0.0 && item.get<double>() <= 255.0;
  };
  if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), is_code)) {
    reader.fail(name, "is no sRGB triple", "3 integers in [0, 255]");
  }
  if (!reader.has(info.name)) {
    reader.fail(name, "stands alone", fmt::format("the linear colour '{}' beside it", info.name));
  }
}

void parameter_from_json(ObjectReader& reader, const ParameterInfo& info, Material& material) {
  if (has_srgb(info)) check_srgb(reader, info);
  if (!reader.has(info.name)) return;
  if (info.components == 3) {
    material.set(info.name, colour_from_json(reader, info));
  } else {
    material.set(info.name, reader.number(info.name, info.lower, info.upper));
  }
}

void parameters_from_json(ObjectReader reader, Effects allowed, Material& material) {
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!allowed.has(info.effect)) {
      if (reader.has(info.name)) {
        reader.fail(info.name,
                    fmt::format("belongs to the effect {}, which is off", effect_name(info.effect)),
                    fmt::format("\"{}\" among the effects", effect_name(info.effect)));
      }
      continue;
    }
    parameter_from_json(reader, info, material);
  }
  reader.finish();
}

// Sets the effects, and what belongs to others to its default: it changes nothing and is not written.
void use_effects(Effects effects, Material& material) {
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!effects.has(info.effect)) material.set(info.name, info.default_value);
  }
  material.set_effects(effects);
}

}  // namespace

Json material_to_json(const Material& material) {
  std::string why;
  if (!material.is_valid(&why)) throw std::invalid_argument("material_to_json: " + why);
  Json json;
  json["brdfit"] = kVersion;
  json["model"] = name_of(material.model());
  json["parameters"] = parameters_to_json(material);
  json["effects"] = effects_to_json(material.effects());
  json["options"] = options_to_json(material);
  return json;
}

Material material_from_json(const Json& json, const std::string& file, const std::string& where) {
  ObjectReader reader(json, file, where);
  reader.integer("brdfit", kVersion, kVersion);
  Material material(model_from_json(reader));
  const bool has_effects = reader.has("effects");
  const Effects effects =
      has_effects ? effects_from_json(reader, material.model()) : effects_of(material.model());
  parameters_from_json(reader.object("parameters"), effects, material);
  if (reader.has("options")) {
    material.options() = options_from_json(reader.object("options"), material.model());
  }
  if (reader.has("fit")) reader.object("fit");  // evidence, for people and tools
  reader.finish();
  use_effects(has_effects ? effects : effects_in_use(material), material);
  return material;
}

Json effects_and_values_to_json(const Material& material) {
  Json json = material_to_json(material);
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (has_srgb(info)) json["parameters"].erase(srgb_name(info));
  }
  return {{"effects", json["effects"]}, {"parameters", json["parameters"]}};
}

Material material_from_effects_and_values(const Material& like, const Json& json, const std::string& file,
                                          const std::string& where) {
  ObjectReader reader(json, file, where);
  Material material(like.model());
  material.options() = like.options();
  const Effects effects = effects_from_json(reader, material.model());
  parameters_from_json(reader.object("parameters"), effects, material);
  reader.finish();
  material.set_effects(effects);
  return material;
}

Material read_material(const std::filesystem::path& file) {
  return material_from_json(read_json(file), file.string());
}

void write_material(const std::filesystem::path& file, const Material& material, const Json& evidence) {
  Json json = material_to_json(material);
  if (!evidence.is_null()) json["fit"] = evidence;
  write_json(file, json);
}

int srgb8_from_linear(double linear) {
  if (!(linear >= 0.0 && linear <= 1.0)) {
    throw std::invalid_argument(fmt::format("srgb8_from_linear: {} is not in [0, 1]", linear));
  }
  const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255.0 * encoded));
}

double linear_from_srgb8(int srgb8) {
  if (srgb8 < 0 || srgb8 > 255) {
    throw std::invalid_argument(fmt::format("linear_from_srgb8: {} is not in [0, 255]", srgb8));
  }
  const double encoded = srgb8 / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace brdfit::io

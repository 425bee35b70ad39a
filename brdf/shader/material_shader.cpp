// Which declarations a material needs, in the words of a shading language.
#include "brdf/shader/material_shader.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "brdf/shader/fold.h"
#include "brdf/shader/kernel_source.h"

namespace brdfit::shader {
namespace {

constexpr std::array<std::string_view, 4> kOptionNames = {"effects", "masking", "diffuse", "burley_g"};

constexpr std::size_t kLineLength = 80;  // of arguments, about

constexpr const char* kGlslMain = R"(
#ifdef BRDF_COMPUTE_MAIN
layout(local_size_x_id = 0) in;
layout(std430, set = 0, binding = 0) readonly buffer Pairs {{ vec4 pairs[]; }};
layout(std430, set = 0, binding = 1) writeonly buffer Results {{ vec4 results[]; }};

void main() {{
  uint k = gl_GlobalInvocationID.x;
  if (k < results.length()) {{
    results[k] = vec4({}pairs[2 * k].xyz, pairs[2 * k + 1].xyz), 0.0);
  }}
}}
#endif
)";

constexpr const char* kHlslMain = R"(
#ifdef BRDF_COMPUTE_MAIN
[[vk::binding(0, 0)]] StructuredBuffer<float4> pairs;
[[vk::binding(1, 0)]] RWStructuredBuffer<float4> results;

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
  uint count;
  uint stride;
  results.GetDimensions(count, stride);
  if (id.x < count) {{
    results[id.x] = float4({}pairs[2 * id.x].xyz, pairs[2 * id.x + 1].xyz), 0.0);
  }}
}}
#endif
)";

// What differs between the models.
struct ModelText {
  std::string_view header;
  std::string_view stem;                 // of its functions
  std::string_view type;                 // of its structs
  std::string_view terms;                // arguments of the terms after the shape
  std::vector<std::string_view> shape;   // parameters
  std::vector<std::string_view> colour;  // "luminance" is that of the base colour
};

const ModelText& text_of(Model model) {
  static const ModelText kLambertGgx = {"lambert_ggx.h", "lambert_ggx",
                                        "LambertGgx",    "g, masking, diffuse",
                                        {"roughness"},   {"base_color", "metallic", "specular"}};
  static const ModelText kBurley = {"burley.h",
                                    "burley",
                                    "Burley",
                                    "g, burley_g, effects",
                                    {"roughness", "subsurface", "anisotropic", "clearcoat_gloss", "effects"},
                                    {"base_color", "luminance", "metallic", "specular", "specular_tint",
                                     "sheen", "sheen_tint", "clearcoat"}};
  static const ModelText kCallisto = {
      "callisto.h",
      "callisto",
      "Callisto",
      "g, geometry_logs(g), masking, diffuse, effects",
      {"roughness", "dual_specular_roughness_scale", "dual_specular_opacity", "diffuse_fresnel_falloff",
       "diffuse_fresnel_tangent_falloff", "retroreflection_falloff", "retroreflection_tangent_falloff",
       "specular_fresnel_falloff", "smooth_terminator_length"},
      {"base_color", "metallic", "specular", "diffuse_fresnel", "retroreflection", "smooth_terminator"}};
  return model == Model::kLambertGgx ? kLambertGgx : model == Model::kBurley ? kBurley : kCallisto;
}

// A number as a literal of a float, the shortest that is read back as the same float.
std::string literal(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), static_cast<float>(value));
  std::string text(buffer.data(), end);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

class Writer {
 public:
  Writer(const Material& material, const ShaderOptions& options)
      : material_(material), options_(options), model_(text_of(material.model())) {
    declarations_ = kernel_declarations(std::span(&model_.header, 1));
    known_["effects"] = static_cast<int>(material.effects().bits());
    known_["masking"] = static_cast<int>(material.options().masking);
    known_["diffuse"] = static_cast<int>(material.options().diffuse);
    known_["burley_g"] = static_cast<int>(material.options().burley_g);
    for (Declaration& declaration : declarations_) prepare(declaration);
  }

  std::string write() {
    const std::string body = (options_.baked ? "" : material_struct() + own_material()) + evaluation();
    // From the last to the first: what is used comes before what uses it.
    std::string kernel;
    std::set<std::string> used = words_of(body);
    for (auto it = declarations_.rbegin(); it != declarations_.rend(); ++it) {
      if (used.count(it->name) == 0) continue;
      used.merge(words_of(it->text));
      kernel = text_of_declaration(*it) + kernel;
    }
    return head() + guard() + finished(kernel + body) + compute_main() + "\n#endif\n";
  }

 private:
  bool is_glsl() const { return options_.language == Language::kGlsl; }
  std::string_view vector() const { return is_glsl() ? "vec3" : "float3"; }

  // Kernel dialect to plain code, branches decided.
  void prepare(Declaration& declaration) {
    if (declaration.kind == Declaration::Kind::kConstant) {
      int value = 0;
      const std::string& text = declaration.text;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error == std::errc{} && end == text.data() + text.size()) known_[declaration.name] = value;
      return;
    }
    std::string& code = declaration.text;
    for (const std::string_view macro : {"OF_REAL", "OF_GEO", "REAL", "GEO", "TO_REAL"})
      code = unwrap_macro(std::move(code), macro);
    for (const std::string macro : {"BRDF_REAL_STRUCT(", "BRDF_GEO_STRUCT("}) {
      if (code.compare(0, macro.size(), macro) == 0) {
        code = "struct " + declaration.name + code.substr(code.find(')') + 1);
      }
    }
    code = replace_words(code, [](const Word& word) {
      return word.text == "Real" || word.text == "Geo" ? std::string("float") : word.text;
    });
    code = fold_branches(std::move(code), known_);
    code = without_options(std::move(code));
    while (!code.empty() && code.back() == '\n') code.pop_back();
  }

  // Options are decided: neither parameters nor arguments. They are never the first of either.
  static std::string without_options(std::string code) {
    for (const std::string_view name : kOptionNames) {
      std::size_t at = 0;
      while ((at = code.find(name, at)) != std::string::npos) {
        const std::size_t end = at + name.size();
        const std::size_t before = code.find_last_not_of(" \n", at - 1);
        const bool has_type = before >= 2 && code.compare(before - 2, 3, "int") == 0;
        const std::size_t comma = has_type ? code.find_last_not_of(" \n", before - 3) : before;
        if (code[comma] == ',' && (code[end] == ',' || code[end] == ')')) {
          code.erase(comma, end - comma);
          at = comma;
        } else {
          at = end;
        }
      }
    }
    return code;
  }

  static std::set<std::string> words_of(const std::string& code) {
    std::set<std::string> words;
    replace_words(code, [&](const Word& word) {
      if (!word.is_member) words.insert(word.text);
      return word.text;
    });
    return words;
  }

  std::string text_of_declaration(const Declaration& declaration) const {
    if (declaration.kind == Declaration::Kind::kConstant) {
      return fmt::format("{}{} {} = {};\n\n", declaration.comment,
                         is_glsl() ? "const float" : "static const float", declaration.name,
                         declaration.text);
    }
    return fmt::format("{}{}\n\n", declaration.comment, declaration.text);
  }

  // Those that the material's effects use.
  std::vector<const ParameterInfo*> used_parameters() const {
    std::vector<const ParameterInfo*> used;
    for (const ParameterInfo& info : parameters_of(material_.model())) {
      if (material_.effects().has(info.effect)) used.push_back(&info);
    }
    return used;
  }

  std::string value_of(const ParameterInfo& info) const {
    const double* values = material_.values().data() + info.offset;
    if (info.components == 1) return literal(values[0]);
    return fmt::format("{}({}, {}, {})", vector(), literal(values[0]), literal(values[1]),
                       literal(values[2]));
  }

  std::string_view type_of(const ParameterInfo& info) const {
    return info.components == 1 ? "float" : vector();
  }

  std::string material_struct() const {
    std::string text = "struct Material {\n";
    for (const ParameterInfo* info : used_parameters()) {
      text += fmt::format("  {} {};  // {}, in [{}, {}]\n", type_of(*info), info->name, info->help,
                          info->lower, info->upper);
    }
    return text + "};\n\n";
  }

  std::string own_material() const {
    std::string text = "Material material() {\n  Material m;\n";
    for (const ParameterInfo* info : used_parameters())
      text += fmt::format("  m.{} = {};\n", info->name, value_of(*info));
    return text + "  return m;\n}\n\n";
  }

  std::string baked_parameters() const {
    std::string text;
    for (const ParameterInfo* info : used_parameters())
      text += fmt::format("  const {} {} = {};\n", type_of(*info), info->name, value_of(*info));
    return text;
  }

  // How the evaluation names a parameter.
  std::string named(std::string_view name) const {
    return fmt::format("{}{}", options_.baked ? "" : "m.", name);
  }

  // A parameter as an argument, of one channel (x, y, z) where it is a colour; its default where its effect
  // is off.
  std::string argument(std::string_view name, std::string_view channel) const {
    if (name == "effects") return "effects";
    if (name == "luminance") return "base_luminance";
    const ParameterInfo& info = *find_parameter(material_.model(), name);
    if (!material_.effects().has(info.effect)) return literal(info.default_value);
    if (info.kind == Kind::kIntensity)
      return fmt::format("{} * {}.{}", named(name), named(info.partner), channel);
    return info.components == 3 ? fmt::format("{}.{}", named(name), channel) : named(name);
  }

  std::string arguments(const std::vector<std::string_view>& names, std::string_view channel) const {
    std::string text;
    std::size_t line = 0;  // its length so far: a shader is read too
    for (const std::string_view name : names) {
      const std::string one = argument(name, channel);
      if (!text.empty()) text += ",";
      if (line + one.size() > kLineLength) {
        text += "\n      ";
        line = 0;
      } else if (!text.empty()) {
        text += " ";
      }
      text += one;
      line += one.size() + 2;
    }
    return text;
  }

  std::string evaluation() const {
    std::string text = fmt::format(
        "// f(wi, wo) cos_i in sr^-1, linear Rec.709; unit directions in the local frame, z = normal.\n"
        "{0} eval_cos({1}{0} wi, {0} wo) {{\n{2}"
        "  Geometry g = geometry_from_directions(wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);\n",
        vector(), options_.baked ? "" : "Material m, ", options_.baked ? baked_parameters() : "");
    if (material_.model() == Model::kBurley) {
      text += fmt::format("  float base_luminance = {0}.x * 0.3 + {0}.y * 0.6 + {0}.z * 0.1;\n",
                          named("base_color"));
    }
    text += fmt::format("  {}Shape shape = {}_shape(\n      {});\n  {}Terms terms = {}_terms(shape, {});\n",
                        model_.type, model_.stem, arguments(model_.shape, "x"), model_.type, model_.stem,
                        model_.terms);
    text += fmt::format("  {} result;\n", vector());
    for (const std::string_view channel : {"x", "y", "z"}) {
      text += fmt::format(
          "  {}Colour colour_{} = {}_colour(\n      {});\n"
          "  result.{} = above_horizon({}_combine(colour_{}, terms), g.cos_i, g.cos_o);\n",
          model_.type, channel, model_.stem, arguments(model_.colour, channel), channel, model_.stem,
          channel);
    }
    return without_options(text + "  return result;\n}\n");
  }

  // Names as they are in the file: with the prefix, and without what a language reserves.
  std::string finished(const std::string& code) const {
    std::set<std::string> functions = {"select", "material", "eval_cos"};
    std::set<std::string> others = {"Material"};
    for (const Declaration& declaration : declarations_) {
      (declaration.kind == Declaration::Kind::kFunction ? functions : others).insert(declaration.name);
    }
    return replace_words(code, [&](const Word& word) {
      const bool is_own = others.count(word.text) != 0 || (word.is_called && functions.count(word.text) != 0);
      if (is_own) return with_prefix(word.text);
      // A primitive type in HLSL.
      if (!is_glsl() && word.text == "line") return std::string("line_of");
      if (!is_glsl() && word.text == "uintBitsToFloat") return std::string("asfloat");
      if (!is_glsl() && word.text == "floatBitsToUint") return std::string("asuint");
      return word.text;
    });
  }

  std::string with_prefix(std::string_view name) const {
    if (name.substr(0, 5) == "BRDF_") name.remove_prefix(5);
    return fmt::format("{}_{}", options_.prefix, name);
  }

  std::string effect_names() const {
    std::string names;
    for (const Effect effect : all_effects()) {
      if ((material_.effects().bits() & static_cast<std::uint32_t>(effect)) != 0)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", effect_name(effect));
    }
    return names.empty() ? "none" : names;
  }

  std::string head() const {
    return fmt::format(
        "// {} material{}{}{}{}.\n// Effects: {}.\n// {}: f cos_i. By itself it compiles with\n//   {}\n",
        title_of(material_.model()), options_.source.empty() ? "" : " of ", options_.source,
        options_.made_by.empty() ? "" : ", made by ", options_.made_by, effect_names(),
        with_prefix("eval_cos"),
        is_glsl() ? "glslc --target-env=vulkan1.1 -std=450 -fshader-stage=compute -DBRDF_COMPUTE_MAIN FILE"
                  : "glslc --target-env=vulkan1.1 -x hlsl -fshader-stage=compute -DBRDF_COMPUTE_MAIN FILE");
  }

  std::string guard() const {
    std::string name = options_.prefix;
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return fmt::format("#ifndef {0}_MATERIAL_INCLUDED\n#define {0}_MATERIAL_INCLUDED\n\n", name);
  }

  std::string compute_main() const {
    const std::string call =
        fmt::format("{}({}", with_prefix("eval_cos"),
                    options_.baked ? "" : fmt::format("{}(), ", with_prefix("material")));
    return fmt::format(fmt::runtime(is_glsl() ? kGlslMain : kHlslMain), call);
  }

  const Material& material_;
  const ShaderOptions& options_;
  const ModelText& model_;
  std::vector<Declaration> declarations_;
  KnownValues known_;
};

}  // namespace

bool ShaderOptions::is_valid(std::string* why) const {
  bool good = !prefix.empty() && std::isdigit(static_cast<unsigned char>(prefix[0])) == 0;
  for (const char c : prefix) good = good && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  // GLSL keeps names with two underscores, and those that start with gl_, to itself.
  good = good && prefix.find("__") == std::string::npos && prefix.back() != '_' && prefix != "gl";
  if (!good && why != nullptr) *why = "\"" + prefix + "\" is no prefix of names in a shader";
  return good;
}

std::string material_shader(const Material& material, const ShaderOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument(why);
  return Writer(material, options).write();
}

}  // namespace brdfit::shader

// What is in the text of an exported shader, and what is not.
#include "brdf/shader/material_shader.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "brdf/shader/fold.h"
#include "brdf/shader/kernel_source.h"

namespace brdfit::shader {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string glsl_of(const Material& material, bool baked = true) {
  ShaderOptions options;
  options.baked = baked;
  return material_shader(material, options);
}

// Whether anything in the text is a word of this name.
bool mentions(const std::string& text, const std::string& name) {
  bool found = false;
  replace_words(text, [&](const Word& word) {
    found = found || word.text == name;
    return word.text;
  });
  return found;
}

TEST(FoldBranches, KeepsTheBranchThatIsTaken) {
  const std::string code =
      "  if ((effects & A) != 0) {\n    x = 1.0;\n  } else {\n    x = 2.0;\n  }\n  y = x;\n";
  EXPECT_EQ(fold_branches(code, {{"effects", 3}, {"A", 2}}), "  x = 1.0;\n  y = x;\n");
  EXPECT_EQ(fold_branches(code, {{"effects", 1}, {"A", 2}}), "  x = 2.0;\n  y = x;\n");
}

TEST(FoldBranches, LeavesOutWhatFollowsAReturn) {
  const std::string code = "{\n  if (mode == B) {\n    return 1.0;\n  }\n  return 2.0;\n}\n";
  EXPECT_EQ(fold_branches(code, {{"mode", 1}, {"B", 1}}), "{\n  return 1.0;\n}\n");
  EXPECT_EQ(fold_branches(code, {{"mode", 0}, {"B", 1}}), "{\n  return 2.0;\n}\n");
}

TEST(FoldBranches, RefusesBranchesOnValues) {
  EXPECT_THROW(fold_branches("if (x > 0.0) y = 1.0;", {}), std::invalid_argument);
  EXPECT_THROW(fold_branches("if (mode == B) y = 1.0;", {{"mode", 1}}), std::invalid_argument);
}

TEST(UnwrapMacro, KeepsParenthesesWhereTheyMatter) {
  EXPECT_EQ(unwrap_macro("a * REAL(0.5) + REAL(b + c) - REAL(f(x) + y) + REAL(f(x))", "REAL"),
            "a * 0.5 + (b + c) - (f(x) + y) + f(x)");
}

TEST(KernelDeclarations, AreAllOfTheHeadersOnce) {
  const std::string_view headers[] = {"callisto.h", "lambert_ggx.h"};
  std::vector<std::string> names;
  for (const Declaration& declaration : kernel_declarations(headers)) names.push_back(declaration.name);
  EXPECT_EQ(std::count(names.begin(), names.end(), "geometry_from_directions"), 1);
  EXPECT_THAT(names, testing::IsSupersetOf(
                         {"BRDF_PI", "CallistoShape", "callisto_shape", "fresnel", "lambert_ggx_terms"}));
  for (const std::string& name : names) EXPECT_FALSE(name.empty());
  const std::string_view missing[] = {"none.h"};
  EXPECT_THROW(kernel_declarations(missing), std::invalid_argument);
}

TEST(MaterialShader, HoldsTheMaterialsEffectsAlone) {
  const Material plain(Model::kCallisto);
  for (const bool baked : {true, false}) {
    const std::string text = glsl_of(plain, baked);
    for (const ParameterInfo& info : parameters_of(Model::kCallisto)) {
      if (info.effect == Effect::kNone) {
        EXPECT_TRUE(mentions(text, std::string(info.name))) << info.name;
      }
    }
    EXPECT_FALSE(mentions(text, "brdf_power_product"));
    EXPECT_FALSE(mentions(text, "brdf_smoothstep_from_zero"));
    EXPECT_FALSE(mentions(text, "exp"));
  }
  Material softened(Model::kCallisto);
  softened.set_effects(Effects().with(Effect::kSmoothTerminator));
  const std::string text = glsl_of(softened);
  EXPECT_TRUE(mentions(text, "brdf_smoothstep_from_zero"));
  EXPECT_FALSE(mentions(text, "brdf_power_product"));
}

TEST(MaterialShader, HoldsNothingOfTheDialect) {
  for (const Model model : all_models()) {
    Material material(model);
    material.set_effects(effects_of(model));
    for (const Language language : {Language::kGlsl, Language::kHlsl}) {
      ShaderOptions options;
      options.language = language;
      options.prefix = "oak";
      const std::string text = material_shader(material, options);
      for (const char* word : {"Real", "Geo", "REAL", "GEO", "TO_REAL", "OF_REAL", "OF_GEO", "BRDF_FUNCTION",
                               "BRDF_NAMESPACE_BEGIN", "effects", "masking", "burley_g", "template"}) {
        EXPECT_FALSE(mentions(text, word)) << word;
      }
      EXPECT_TRUE(mentions(text, "oak_eval_cos"));
      EXPECT_FALSE(mentions(text, "brdf_eval_cos"));
    }
  }
}

TEST(MaterialShader, ChoosesItsOptions) {
  Material material(Model::kLambertGgx);
  EXPECT_THAT(glsl_of(material), AllOf(HasSubstr("brdf_smith_share("), Not(HasSubstr("brdf_proxima"))));
  material.options().masking = Masking::kCorrelated;
  material.options().diffuse = Diffuse::kProxima;
  EXPECT_THAT(glsl_of(material), AllOf(Not(HasSubstr("brdf_smith_share(")), HasSubstr("brdf_proxima")));
}

TEST(MaterialShader, HasItsParametersAsConstantsOrInAStruct) {
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.3125);
  EXPECT_THAT(glsl_of(material, true),
              AllOf(HasSubstr("const float roughness = 0.3125;"), Not(HasSubstr("brdf_Material"))));
  EXPECT_THAT(glsl_of(material, false),
              AllOf(HasSubstr("m.roughness = 0.3125;"), HasSubstr("struct brdf_Material {")));
}

TEST(MaterialShader, RefusesPrefixesThatAreNoNames) {
  for (const char* prefix : {"", "2nd", "a b", "a__b", "a_", "gl", "a-b"}) {
    ShaderOptions options;
    options.prefix = prefix;
    EXPECT_THROW(material_shader(Material(), options), std::invalid_argument) << prefix;
  }
}

}  // namespace
}  // namespace brdfit::shader

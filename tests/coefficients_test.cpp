// The product form: what a model depends on, with intensities and tints multiplied.
#include "brdf/coefficients.h"

#include <gmock/gmock.h>

#include "tests/random_parameters.h"

namespace brdfit {
namespace {

using testing_support::Random;

// The entry of the product form for a parameter and channel.
double entry_of(const Material& material, std::string_view parameter, int channel) {
  const auto layout = product_layout(material.model());
  const auto product = product_form(material);
  for (std::size_t k = 0; k < layout.size(); ++k) {
    if (layout[k].parameter == parameter && layout[k].channel == channel) return product[k];
  }
  ADD_FAILURE() << "no entry for " << parameter;
  return 0.0;
}

TEST(ProductLayout, HasTheDeclaredSizes) {
  EXPECT_EQ(product_layout(Model::kLambertGgx).size(), static_cast<std::size_t>(kLambertGgxProductSize));
  EXPECT_EQ(product_layout(Model::kBurley).size(), static_cast<std::size_t>(kBurleyProductSize));
  EXPECT_EQ(product_layout(Model::kCallisto).size(), static_cast<std::size_t>(kCallistoProductSize));
}

TEST(ProductLayout, HoldsEveryParameterOnceAndTintsAsFactors) {
  for (const Model model : all_models()) {
    const auto layout = product_layout(model);
    for (const ParameterInfo& info : parameters_of(model)) {
      const auto entries = std::ranges::count(layout, info.name, &ProductEntry::parameter);
      const auto factors = std::ranges::count(layout, info.name, &ProductEntry::tint);
      const bool wide = info.kind == Kind::kColour || info.kind == Kind::kIntensity;
      EXPECT_EQ(entries, info.kind == Kind::kTint ? 0 : wide ? 3 : 1) << info.name;
      EXPECT_EQ(factors, info.kind == Kind::kTint ? 3 : 0) << info.name;
    }
  }
}

TEST(ProductForm, MultipliesIntensitiesWithTheirTints) {
  Material material(Model::kCallisto);
  material.set_effects(effects_of(Model::kCallisto));
  material.set("retroreflection", 8.0);
  material.set("retroreflection_tint", Rgb{1.0, 0.5, 0.25});
  material.set("smooth_terminator", -0.5);
  material.set("smooth_terminator_tint", Rgb{0.2, 1.0, 0.4});
  for (const auto& [name, product] : {std::pair{"retroreflection", Rgb{8.0, 4.0, 2.0}},
                                      std::pair{"smooth_terminator", Rgb{-0.1, -0.5, -0.2}},
                                      std::pair{"diffuse_fresnel", Rgb{1.0, 1.0, 1.0}}}) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(entry_of(material, name, c), product[static_cast<std::size_t>(c)]);
  }
}

TEST(ProductForm, CarriesOtherParametersUnchanged) {
  Random random(61);
  for (const Model model : all_models()) {
    const Material material = testing_support::random_material(model, effects_of(model), random);
    for (const ProductEntry& entry : product_layout(model)) {
      if (!entry.tint.empty()) continue;
      EXPECT_EQ(entry_of(material, entry.parameter, entry.channel),
                material.colour(entry.parameter)[static_cast<std::size_t>(entry.channel)])
          << entry.parameter;
    }
  }
}

TEST(ProductForm, OfEffectsThatAreOffStandsAtTheDefaults) {
  Random random(62);
  for (const Model model : all_models()) {
    const Material material = testing_support::random_material(model, {}, random);
    Material neutral(model);
    for (const ParameterInfo& info : parameters_of(Model::kLambertGgx)) {
      for (int c = 0; c < info.components; ++c) {
        const auto at = static_cast<std::size_t>(info.offset + c);
        neutral.values()[at] = material.values()[at];
      }
    }
    EXPECT_EQ(product_form(material), product_form(neutral)) << name_of(model);
  }
}

TEST(ProductForm, TurnsOffOneEffectAtATime) {
  Random random(63);
  for (const Model model : {Model::kBurley, Model::kCallisto}) {
    const Effects all = effects_of(model);
    for (const Effect effect : all_effects()) {
      if ((all.bits() & static_cast<std::uint32_t>(effect)) == 0) continue;
      Material material = testing_support::interior_material(model, all, random);
      const auto with = product_form(material);
      material.set_effects(all.without(effect));
      const auto without = product_form(material);
      const auto layout = product_layout(model);
      for (std::size_t k = 0; k < layout.size(); ++k) {
        const ParameterInfo& info = *find_parameter(model, layout[k].parameter);
        EXPECT_EQ(without[k], info.effect == effect ? info.default_value : with[k]) << info.name;
      }
    }
  }
}

TEST(Coefficients, OfTheMetallicWorkflow) {
  const double q[] = {0.2, 0.5, 0.9, 0.25, 0.5, 0.3};
  const auto k = lambert_ggx_coefficients(q);
  EXPECT_DOUBLE_EQ(k.shape.alpha, 0.09);
  EXPECT_DOUBLE_EQ(k.colour[1].rho, 0.375);
  EXPECT_DOUBLE_EQ(k.colour[1].f0, 0.75 * 0.04 + 0.25 * 0.5);
}

}  // namespace
}  // namespace brdfit

// A small light stack on disk, made by the program, for tests of what bakes it and of what reads bakes.
#ifndef BRDFIT_TESTS_CLI_STACK_FIXTURE_H_
#define BRDFIT_TESTS_CLI_STACK_FIXTURE_H_

#include "data/synthetic/stack_recipe.h"
#include "tests/cli_fixture.h"

namespace brdfit::tests {

class CliStackFixture : public CliFixture {
 protected:
  // A matte surface with a residual that no model explains. Its stack is stack/bumps.olat.json.
  static synthetic::StackRecipe matte_bumps(int width, int height, int lights) {
    synthetic::StackRecipe recipe;
    recipe.name = "bumps";
    recipe.width = width;
    recipe.height = height;
    Material material(Model::kLambertGgx);
    material.set("base_color", 0.6);
    material.set("specular", 0.0);
    recipe.materials = {material};
    recipe.shape.slope = 0.4;
    recipe.shape.wavelength_px = 16;
    recipe.cast_shadows = false;
    recipe.lights.count = lights;
    recipe.lights.theta_deg = 60;
    recipe.residual = {4, 6.0, 180.0, 0.2};
    return recipe;
  }

  void synth(const synthetic::StackRecipe& recipe) {
    io::write_json(path("recipe.json"), synthetic::stack_recipe_to_json(recipe));
    const ProgramResult made = run("synth -q --force -o " + quoted("stack") + " " + quoted("recipe.json"));
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
};

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_CLI_STACK_FIXTURE_H_

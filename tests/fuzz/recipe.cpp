// Recipes of tables and of stacks.
#include "data/synthetic/recipe.h"

#include "data/synthetic/stack_recipe.h"
#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {
namespace {

void require_valid(const auto& recipe) {
  std::string why;
  require(recipe.is_valid(&why), "a recipe that is read is valid: " + why);
}

}  // namespace

bool run_recipe(Bytes input) {
  return run_json(input, synthetic::read_recipe, require_valid<synthetic::Recipe>, synthetic::write_recipe);
}

bool run_stack_recipe(Bytes input) {
  return run_json(input, synthetic::read_stack_recipe, require_valid<synthetic::StackRecipe>,
                  [](const auto& file, const synthetic::StackRecipe& recipe) {
                    io::write_json(file, synthetic::stack_recipe_to_json(recipe));
                  });
}

}  // namespace brdfit::fuzz

// Published parameters, from the recipes that were built in.
#include "cli/published.h"

#include <array>
#include <string_view>

#include "data/synthetic/recipe.h"
#include "io/json.h"

namespace brdfit::cli {
namespace {

struct BuiltIn {
  std::string_view name;  // "blue-fabric.callisto"
  std::string_view json;
};

constexpr BuiltIn kRecipes[] = {
#include "cli/published_recipes.inc"
};

}  // namespace

std::vector<Material> published_materials(const std::string& name) {
  std::vector<Material> materials;
  for (const Model model : all_models()) {
    const std::string wanted = name + "." + std::string(name_of(model));
    for (const BuiltIn& recipe : kRecipes) {
      if (recipe.name != wanted) continue;
      materials.push_back(synthetic::recipe_from_json(io::Json::parse(recipe.json), wanted).material);
    }
  }
  return materials;
}

}  // namespace brdfit::cli

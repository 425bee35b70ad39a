// Off the second lobe's plateau.
#include "fit/plateau.h"

#include <algorithm>
#include <optional>
#include <string_view>

namespace brdfit::fit {
namespace {

std::optional<std::size_t> index_of(const Parametrisation& parametrisation, std::string_view name) {
  const auto found = std::ranges::find(parametrisation.free, name, &FreeParameter::name);
  if (found == parametrisation.free.end()) return std::nullopt;
  return static_cast<std::size_t>(found - parametrisation.free.begin());
}

}  // namespace

bool leave_plateau(const Parametrisation& parametrisation, std::vector<double>& x) {
  constexpr double kSecondRoughness = 0.85;
  const auto roughness = index_of(parametrisation, "roughness");
  const auto scale = index_of(parametrisation, "dual_specular_roughness_scale");
  if (!roughness || !scale || x[*roughness] * x[*scale] < 1.0) return false;
  x[*scale] = std::max(kSecondRoughness / x[*roughness], 1.0);
  return true;
}

}  // namespace brdfit::fit

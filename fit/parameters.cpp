// Free parameters and their map to a model's product form.
#include "fit/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "brdf/coefficients.h"

namespace brdfit::fit {
namespace {

constexpr std::array<const char*, 3> kChannelSuffix = {".r", ".g", ".b"};

void apply_fixed(Material& material, const FixedValues& fixed) {
  for (const auto& [name, values] : fixed) {
    const ParameterInfo* info = find_parameter(material.model(), name);
    if (info == nullptr) {
      throw std::invalid_argument(std::string(title_of(material.model())) + " has no parameter \"" + name +
                                  "\"");
    }
    if (!material.effects().has(info->effect)) {
      throw std::invalid_argument("\"" + name + "\" is fixed, but its effect " +
                                  std::string(effect_name(info->effect)) + " is off");
    }
    if (values.size() == 1) {
      material.set(name, values[0]);
    } else if (values.size() == 3 && info->components == 3) {
      material.set(name, Rgb{values[0], values[1], values[2]});
    } else {
      throw std::invalid_argument("\"" + name + "\" takes " +
                                  (info->components == 3 ? "1 or 3 numbers" : "1 number"));
    }
  }
  std::string why;
  if (!material.is_valid(&why)) throw std::invalid_argument(why);
}

// Builds a parametrisation entry by entry.
class Builder {
 public:
  Builder(const Material& start, const FreedomOptions& options) : options_(options) {
    result_.start = start;
    result_.start.set_effects(effects_in(options, start.model()));
    reset_groups_that_are_off();
    apply_fixed(result_.start, options.fixed);
  }

  Parametrisation build() {
    const std::vector<double> at_start = product_form(result_.start);
    const std::vector<ProductEntry> layout = product_layout(result_.start.model());
    for (std::size_t k = 0; k < layout.size(); ++k) {
      const ProductEntry& entry = layout[k];
      const bool parameter_free = is_free(entry.parameter);
      const bool tint_free = !entry.tint.empty() && is_free(entry.tint);
      if (parameter_free && tint_free) {
        add_product(entry);
      } else if (parameter_free) {
        add_single(entry);
      } else if (tint_free) {
        add_tint(entry);
      } else {
        add_entry(-1, 0.0, at_start[k]);
      }
    }
    return std::move(result_);
  }

 private:
  const ParameterInfo& info(std::string_view name) const {
    return *find_parameter(result_.start.model(), name);
  }

  static Effects effects_in(const FreedomOptions& options, Model model) {
    if (!options.groups) return options.effects;
    return Effects(options.effects.bits() & effects_of_groups(model, *options.groups).bits());
  }

  bool group_is_on(std::string_view name) const {
    const auto group = group_of_parameter(result_.start.model(), name);
    return !group || !options_.groups || options_.groups->has(*group);
  }

  void reset_groups_that_are_off() {
    for (const ParameterInfo& row : parameters_of(result_.start.model())) {
      if (group_is_on(row.name)) continue;
      if (options_.fixed.contains(std::string(row.name))) {
        throw std::invalid_argument("\"" + std::string(row.name) + "\" is fixed, but its group is off");
      }
      result_.start.set(row.name, row.default_value);
    }
  }

  bool is_free(std::string_view name) const {
    const ParameterInfo& row = info(name);
    // Isotropic data say nothing of a stretched highlight.
    if (row.effect == Effect::kAnisotropic) return false;
    return row.tier <= options_.tier && result_.start.effects().has(row.effect) && group_is_on(name) &&
           !options_.fixed.contains(std::string(name));
  }

  void add_entry(int source, double factor, double constant) {
    result_.source.push_back(source);
    result_.factor.push_back(factor);
    result_.constant.push_back(constant);
  }

  int add_free(const FreeParameter& parameter) {
    result_.free.push_back(parameter);
    return static_cast<int>(result_.free.size()) - 1;
  }

  // An intensity and its tint: the optimiser moves their product in each channel.
  void add_product(const ProductEntry& entry) {
    const ParameterInfo& row = info(entry.parameter);
    const std::string name(entry.parameter);
    const int at = add_free({name + kChannelSuffix[static_cast<std::size_t>(entry.channel)], name,
                             std::string(entry.tint), row.lower, row.upper, row.upper > 1.0});
    if (row.lower < 0.0) result_.one_signed.push_back(static_cast<std::size_t>(at));
    add_entry(at, 1.0, 0.0);
  }

  // A number, a channel of a colour, or an intensity whose tint is fixed (one number for three entries).
  void add_single(const ProductEntry& entry) {
    const ParameterInfo& row = info(entry.parameter);
    const std::string name(entry.parameter);
    const double factor =
        entry.tint.empty() ? 1.0 : result_.start.colour(entry.tint)[static_cast<std::size_t>(entry.channel)];
    int at = static_cast<int>(result_.free.size()) - 1;
    if (row.components == 3) {
      at = add_free({name + kChannelSuffix[static_cast<std::size_t>(entry.channel)], name, "", row.lower,
                     row.upper, false});
    } else if (entry.channel == 0) {
      at = add_free({name, name, "", row.lower, row.upper, row.kind == Kind::kIntensity && row.upper > 1.0});
    }
    add_entry(at, factor, 0.0);
  }

  // A tint whose intensity is fixed.
  void add_tint(const ProductEntry& entry) {
    const ParameterInfo& row = info(entry.tint);
    const std::string name(entry.tint);
    const int at = add_free({name + kChannelSuffix[static_cast<std::size_t>(entry.channel)], name, "",
                             row.lower, row.upper, false});
    add_entry(at, result_.start.number(entry.parameter), 0.0);
  }

  const FreedomOptions& options_;
  Parametrisation result_;
};

// Splits products of three channels into an intensity and a tint whose largest channel is 1.
void set_product(Material& material, const std::string& intensity, const std::string& tint,
                 const Rgb& product) {
  const auto largest = std::ranges::max_element(product, {}, [](double v) { return std::abs(v); });
  material.set(intensity, *largest);
  Rgb share = {1.0, 1.0, 1.0};
  if (*largest != 0.0) {
    // Adding 0 turns the -0 of a negative intensity into 0.
    for (std::size_t c = 0; c < 3; ++c) share[c] = std::clamp(product[c] / *largest + 0.0, 0.0, 1.0);
  }
  material.set(tint, share);
}

std::size_t channel_of(const FreeParameter& parameter) {
  switch (parameter.name.back()) {
    case 'g':
      return parameter.name[parameter.name.size() - 2] == '.' ? 1 : 0;
    case 'b':
      return parameter.name[parameter.name.size() - 2] == '.' ? 2 : 0;
    default:
      return 0;
  }
}

}  // namespace

std::vector<double> Parametrisation::from_material(const Material& material) const {
  std::vector<double> x;
  for (const FreeParameter& parameter : free) {
    const std::size_t channel = channel_of(parameter);
    double value = material.colour(parameter.parameter)[channel];
    if (!parameter.tint.empty()) value *= material.colour(parameter.tint)[channel];
    x.push_back(std::clamp(value, parameter.lower, parameter.upper));
  }
  return x;
}

Material Parametrisation::to_material(std::span<const double> x) const {
  Material material = start;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FreeParameter& parameter = free[k];
    if (!parameter.tint.empty()) {
      if (channel_of(parameter) == 0)
        set_product(material, parameter.parameter, parameter.tint, {x[k], x[k + 1], x[k + 2]});
      continue;
    }
    const ParameterInfo& info = *find_parameter(material.model(), parameter.parameter);
    material.values()[static_cast<std::size_t>(info.offset) + channel_of(parameter)] = x[k];
  }
  return material;
}

std::vector<double> Parametrisation::product(std::span<const double> x) const {
  std::vector<double> q(source.size());
  for (std::size_t k = 0; k < q.size(); ++k) {
    q[k] = source[k] >= 0 ? factor[k] * x[static_cast<std::size_t>(source[k])] : constant[k];
  }
  return q;
}

double Parametrisation::scale(std::size_t k, double x) const {
  const FreeParameter& parameter = free[k];
  return parameter.relative ? std::max(std::abs(x), 1.0) : parameter.upper - parameter.lower;
}

Parametrisation make_parametrisation(const Material& start, const FreedomOptions& options) {
  return Builder(start, options).build();
}

}  // namespace brdfit::fit

// Identity of fits.
#include "cli/fit_request.h"

#include <fmt/format.h>

#include "cli/result_json.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

bool is_fit_option(const std::string& name) {
  // Asked of a parser that has nothing else, so that the two never differ.
  static const std::vector<std::string> kNames = [] {
    CLI::App app;
    FitArguments arguments;
    add_fit_arguments(app, arguments);
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
    return names;
  }();
  return name != "--help" && std::ranges::find(kNames, name) != kNames.end();
}

std::string joined(const std::vector<std::string>& words, char separator) {
  return fmt::format("{}", fmt::join(words, std::string(1, separator)));
}

}  // namespace

std::string request_of(const fit::FitOptions& options, const FitArguments& arguments) {
  io::Json json = fit_options_to_json(options);
  json["model"] = name_of(options.model);
  json["masking"] = name_of(options.material_options.masking);
  json["burley_g"] = name_of(options.material_options.burley_g);
  json["diffuse"] = name_of(options.material_options.diffuse);
  json["effect_bits"] = options.effects ? io::Json(options.effects->bits()) : io::Json("all");
  if (options.init) json["init"] = io::material_to_json(*options.init);
  json["cell"] = arguments.cell;
  json["lenient"] = arguments.lenient;
  return io::sha256_of_text(json.dump());
}

std::string given_fit_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || !is_fit_option(option->get_name())) continue;
    if (option->get_items_expected_max() == 0) {
      text += " " + option->get_name();
      // A flag that stands for a number.
      if (option->results().front() != "true") text += "=" + option->results().back();
    } else if (option->get_delimiter() != '\0') {
      text += fmt::format(" {} {}", option->get_name(), joined(option->results(), option->get_delimiter()));
    } else {
      for (const std::string& value : option->results()) {
        text += fmt::format(" {} {}", option->get_name(), quoted_word(value));
      }
    }
  }
  return text;
}

}  // namespace brdfit::cli

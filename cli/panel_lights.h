// Which lights of a stack `bake --panels` draws.
#ifndef BRDFIT_CLI_PANEL_LIGHTS_H_
#define BRDFIT_CLI_PANEL_LIGHTS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace brdfit::cli {

struct PanelLight {
  std::uint32_t light = 0;         // of the stack
  std::string file;                // of its panel, without a folder
  std::vector<std::string> words;  // of "worst", "median", "best", those that chose it
};

// Whether any of what is asked for is known only from held-out errors: "worst", "median", "best".
bool needs_errors(std::span<const std::string> asked);

// Lights in their order, each once. asked: "worst", "median", "best", "all"; a picture's name, with or
// without its ending; or its place from 0 among the names. names: of pictures. errors: one per light, empty
// where there are none. Throws UsageError: what is no light of the stack, a name that several have, words
// without errors.
std::vector<PanelLight> panel_lights(std::span<const std::string> asked, std::span<const std::string> names,
                                     std::span<const double> errors);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_PANEL_LIGHTS_H_

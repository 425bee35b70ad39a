// The pictures of a bake's evidence: panels of held-out lights, and the map of where Realis helps.
#ifndef BRDFIT_CLI_BAKE_PICTURES_H_
#define BRDFIT_CLI_BAKE_PICTURES_H_

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/evidence.h"
#include "bake/held_out_picture.h"
#include "cli/bake_options.h"
#include "cli/held_out_panel.h"
#include "cli/panel_lights.h"
#include "measured/image_stack.h"

namespace brdfit::cli {

// Fed with the plans of folds, then with the stack's rows in passes from top to bottom, of which the first
// is the one that writes the asset. Holds a grid of texels of each panel, never all lights of them; panels
// that do not fit into a quarter of --memory wait for further passes.
class BakePictures {
 public:
  // Refers to all of them. Throws UsageError for lights that the stack has not.
  BakePictures(const BakeArguments& a, const StackInfo& info, const bake::BakeSettings& settings,
               std::string asset_name);
  BakePictures(const BakePictures&) = delete;
  BakePictures& operator=(const BakePictures&) = delete;

  bool is_wanted() const { return !asked_.empty(); }
  // A fold's plans, as evaluate() hands them over.
  void keep(int fold, bake::FoldPlans plans);
  // Chooses lights and plans the folds that nobody handed over. evidence: null where there is none. Throws
  // UsageError where a picture is there already and must not be overwritten.
  void prepare(const TexelBlock& sample, const bake::Evidence* evidence);
  // Rows of the current pass, in order.
  void add(const TexelBlock& strip);
  // Ends the first pass: writes what it has, and makes the others.
  void finish(ImageStack& stack, int strip_rows, const std::function<void()>& check_interruption);
  // As docs/schema/realis.schema.json has it.
  io::Json json() const { return json_; }

 private:
  struct Fold {
    bake::FoldPlans plans;
    bake::LightChoice lights;  // held out
    std::optional<bake::HeldOutBaker> baker;
  };
  // A panel while its rows come in.
  struct Gathering {
    const PanelLight* choice;
    HeldOutPanel panel;
  };
  TexelBlock on_grid(const TexelBlock& strip) const;
  void add_light(std::uint32_t light, const bake::HeldOutTexels& texels, const TexelBlock& block);
  void write_pass();
  std::filesystem::path folder() const;
  std::size_t panels_at_once() const;
  void begin_pass(std::size_t first);

  const BakeArguments& a_;
  const StackInfo& info_;
  const bake::BakeSettings& settings_;
  std::string name_;
  std::vector<std::string> asked_;
  TexelGrid grid_;
  std::vector<PanelLight> panels_;
  int folds_ = 0;
  std::map<int, Fold> plans_;
  std::optional<BenefitMap> benefit_;       // in the first pass
  std::map<std::uint32_t, Gathering> now_;  // panels of the pass, by light
  std::size_t next_ = 0;                    // the first panel of the next pass
  io::Json json_ = io::Json::object();
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_PICTURES_H_

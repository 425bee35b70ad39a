// The ladder of a fit, as its evidence has it, with a small slice of every rung.
#ifndef BRDFIT_CLI_REPORT_LADDER_H_
#define BRDFIT_CLI_REPORT_LADDER_H_

#include <optional>

#include "cli/result_folder.h"
#include "measured/table.h"
#include "render/report.h"
#include "render/slice.h"
#include "render/view.h"

namespace brdfit::cli {

// How slices of rungs are drawn.
struct RungPictures {
  render::SliceOptions slice;
  render::ViewOptions view;
  const MeasuredTable* measured = nullptr;  // null: differences are not drawn
};

// Nothing where the evidence holds no ladder, or one that is not whole. A rung whose material the evidence
// does not hold, or that is not sound, has no slice.
std::optional<render::ReportLadder> report_ladder(const FittedMaterial& fitted, const RungPictures& pictures);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_REPORT_LADDER_H_

// What a bake found, as JSON and as text.
#ifndef BRDFIT_CLI_BAKE_EVIDENCE_H_
#define BRDFIT_CLI_BAKE_EVIDENCE_H_

#include <string>

#include "bake/evidence.h"
#include "bake/plan.h"
#include "io/json.h"

namespace brdfit::cli {

// "Lambert", or the material's model.
std::string title_of(const bake::BaseModel& base);

// Per method: its errors; see docs/schema/realis.schema.json.
io::Json evidence_json(const bake::Evidence& evidence);
// What was decided: gains, base model, lobes, notes.
io::Json plan_json(const bake::BakePlan& plan, const StackInfo& info);

// A table of methods by their errors.
std::string evidence_text(const bake::Evidence& evidence, const StackInfo& info);
std::string plan_text(const bake::BakePlan& plan, const StackInfo& info);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_EVIDENCE_H_

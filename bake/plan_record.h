// Plans and evidence as bytes, and back with every bit: a bake that goes on from them ends as one that was
// never interrupted. For the program and the machine that wrote them.
#ifndef BRDFIT_BAKE_PLAN_RECORD_H_
#define BRDFIT_BAKE_PLAN_RECORD_H_

#include <cstddef>
#include <span>
#include <vector>

#include "bake/evidence.h"
#include "bake/plan.h"
#include "brdf/realis.h"

namespace brdfit::bake {

std::vector<std::byte> plan_record(BakePlan plan);
std::vector<std::byte> fold_record(FoldEvidence fold);
std::vector<std::byte> evidence_record(Evidence evidence);
std::vector<std::byte> ranges_record(std::vector<RealisRange> ranges);

// The inverses. Throw BadRecord, or std::invalid_argument, for bytes that are no such record.
BakePlan plan_of_record(std::span<const std::byte> bytes);
FoldEvidence fold_of_record(std::span<const std::byte> bytes);
Evidence evidence_of_record(std::span<const std::byte> bytes);
std::vector<RealisRange> ranges_of_record(std::span<const std::byte> bytes);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_PLAN_RECORD_H_

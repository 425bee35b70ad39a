// What an interrupted bake leaves, for the same command to go on from.
#ifndef BRDFIT_CLI_BAKE_RESTART_H_
#define BRDFIT_CLI_BAKE_RESTART_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bake/evidence.h"
#include "bake/plan.h"
#include "cli/clocks.h"
#include "cli/common.h"
#include "cli/kept_rows.h"
#include "io/json.h"

namespace brdfit::cli {

// A folder beside the asset's files: what was planned, the evidence or as many of its folds as were done, and
// finished strips. Each lies there complete and with its checksum, or does not count; all belong to one key
// (bake_key). The folder is made when there is something to keep. Where it cannot be written the bake goes on
// without.
//
// Strips cost time to write, so not all of them are kept where they are soon made anew: writing them takes no
// more than a hundredth of the time of the bake.
class BakeRestart {
 public:
  // folder: NAME.realis.part. fresh: what is there does not count. Throws UsageError where another bake is at
  // work in it.
  BakeRestart(std::filesystem::path folder, const io::Json& key, bool fresh);
  BakeRestart(const BakeRestart&) = delete;
  BakeRestart& operator=(const BakeRestart&) = delete;
  ~BakeRestart();

  // What is taken over, or why nothing is, in a line; empty where nothing is there. height: of the asset;
  // folds: of its evidence.
  std::string found(int height, int folds) const;
  // For the line of an interruption: that the same command goes on, or that there is nothing to go on from.
  std::string how_to_go_on() const;

  // Nothing where it is not kept, or damaged.
  const std::optional<bake::BakePlan>& plan() const { return plan_; }
  const std::optional<std::vector<RealisRange>>& ranges() const { return ranges_; }
  const std::optional<bake::Evidence>& evidence() const { return evidence_; }
  bool has_fold(int fold) const { return folds_.contains(fold); }
  std::optional<bake::FoldEvidence> fold(int fold);

  void keep_plan(const bake::BakePlan& plan);
  void keep_ranges(const std::vector<RealisRange>& ranges);
  void keep_evidence(const bake::Evidence& evidence);
  void keep_fold(int fold, const bake::FoldEvidence& evidence);
  // As bake::EvidenceOptions::fold_of has it.
  bake::FoldEvidence fold_of(int fold, const std::function<bake::FoldEvidence()>& make);

  // Rows of the strip that is kept from this row on; 0: none is.
  int rows_at(int row) const { return rows_ ? rows_->rows_at(row) : 0; }
  // The next row that is kept; `end` where none is.
  int next_kept(int row, int end) const { return rows_ ? rows_->next(row, end) : end; }
  KeptStrip strip(int row) const { return rows_->read(row); }
  // Keeps it, or not, by what that takes.
  void keep_strip(int row, int rows, const KeptStrip& strip);

  // All that is left is to give files their names: those that are there then may be of this bake.
  void keep_outputs_begun();
  bool has_outputs_begun() const { return outputs_begun_; }

  // The asset is complete.
  void remove();

 private:
  class Lock;
  void take_over();
  void remove_left_temporaries() const;
  void remove_files() const;
  std::filesystem::path fold_file(int fold) const;
  std::optional<std::vector<std::byte>> piece(const std::string& name);
  void keep_piece(const std::string& name, const std::function<std::vector<std::byte>()>& record);
  bool begin();
  bool is_cheap(std::size_t bytes) const;

  std::filesystem::path folder_;
  io::Json key_;
  std::string key_hash_;
  std::unique_ptr<Lock> lock_;
  bool is_begun_ = false;  // the folder is of this key
  bool has_failed_ = false;
  bool outputs_begun_ = false;
  std::string refusal_;
  std::vector<std::string> damaged_;
  std::optional<bake::BakePlan> plan_;
  std::optional<std::vector<RealisRange>> ranges_;
  std::optional<bake::Evidence> evidence_;
  std::set<int> folds_;
  std::unique_ptr<KeptRows> rows_;
  BothClocks clocks_;
  TimeTaken strip_time_;  // that keeping strips took
  std::size_t strip_bytes_ = 0;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_RESTART_H_

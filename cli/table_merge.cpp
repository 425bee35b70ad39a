// Merging of runs.
#include "cli/table_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "cli/common.h"
#include "cli/result_json.h"
#include "cli/table_output.h"
#include "cli/version.h"

namespace brdfit::cli {
namespace {

using io::Json;
namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& found, const std::string& advice = "") {
  throw io::IoError(io::IoError::Side::kInput, file.string(), found,
                    "the table.json of a run of `brdfit table` by this version", advice);
}

Json read_table(const fs::path& folder) {
  const fs::path file = folder / "table.json";
  Json json = io::read_json(file);
  for (const char* key : {"brdfit_table", "version", "rows", "failures"}) {
    if (!json.is_object() || !json.contains(key)) refuse(file, fmt::format("lacks \"{}\"", key));
  }
  if (json["version"] != kVersion) refuse(file, "is of version " + json["version"].dump());
  if (!json["rows"].is_array() || !json["failures"].is_object()) refuse(file, "has no rows");
  return json;
}

// The result as it would stand in another folder: the way to its input differs.
Json moved(Json document, const fs::path& from, const fs::path& to) {
  if (!document.contains("fit")) return document;
  Json& path = document["fit"]["input"]["path"];
  if (path.is_string() && !path.get<std::string>().empty()) {
    path = path_from(to, from / path.get<std::string>());
  }
  return document;
}

Json without_timings(Json document) {
  document.erase("timings_seconds");
  if (document.contains("fit")) document["fit"].erase("timings_seconds");
  return document;
}

class Merger {
 public:
  explicit Merger(fs::path output) : output_(std::move(output)) {}

  void add(const fs::path& folder) {
    const Json json = read_table(folder);
    note_shard(json, folder / "table.json");
    for (const Json& row : json["rows"]) {
      const auto name = row.is_object() ? row.find("file") : row.end();
      if (!row.is_object() || name == row.end() || !name->is_string() ||
          fs::path(name->get<std::string>()).filename() != name->get<std::string>()) {
        refuse(folder / "table.json", "has a row that names no file");
      }
      add_result(folder, name->get<std::string>());
    }
    for (const auto& [file, why] : json["failures"].items()) {
      table_.failures[file] = why.is_string() ? why.get<std::string>() : why.dump();
    }
  }

  // Every shard of a run that was split must be there.
  void require_complete() const {
    for (int index = 1; index <= count_; ++index) {
      if (seen_.contains(index)) continue;
      throw io::IoError(io::IoError::Side::kInput, fmt::format("shard {} of {}", index, count_), "is missing",
                        "a folder for each shard", "run it, and merge again");
    }
  }

  ResultTable write(bool force) {
    require_own_tables(output_, force);
    for (const auto& [name, document] : documents_) prepare_output(output_ / name, force);
    prepare_output(output_ / "table.json", true);
    sort_rows(table_.rows);
    for (const auto& [name, document] : documents_) io::write_json(output_ / name, document);
    write_tables(output_, table_, {});
    return std::move(table_);
  }

 private:
  void note_shard(const Json& json, const fs::path& file) {
    if (!json.contains("shard")) return;
    const Json& shard = json["shard"];
    if (!shard.is_object() || !shard.contains("index") || !shard.contains("count") ||
        !shard["index"].is_number_integer() || !shard["count"].is_number_integer()) {
      refuse(file, "has a member \"shard\" that says nothing");
    }
    const int count = shard["count"].get<int>();
    if (count_ != 0 && count != count_) {
      refuse(file, fmt::format("is one of {} shards, others of {}", count, count_),
             "merge one run at a time");
    }
    count_ = count;
    seen_.insert(shard["index"].get<int>());
  }

  void add_result(const fs::path& folder, const std::string& name) {
    const Json document = moved(io::read_json(folder / name), folder, output_);
    ResultRow row = row_of_result(document, folder / name);
    const auto found = documents_.find(name);
    if (found == documents_.end()) {
      documents_[name] = document;
      table_.rows.push_back(std::move(row));
    } else if (without_timings(found->second) != without_timings(document)) {
      throw UsageError(
          fmt::format("{} differs from what another folder holds of that name", (folder / name).string()));
    }
  }

  fs::path output_;
  std::map<std::string, Json> documents_;
  ResultTable table_;
  std::set<int> seen_;
  int count_ = 0;
};

}  // namespace

ResultTable merge_runs(const std::vector<std::string>& folders, const fs::path& output, bool force) {
  Merger merger(output);
  for (const std::string& folder : folders) merger.add(folder);
  merger.require_complete();
  return merger.write(force);
}

}  // namespace brdfit::cli

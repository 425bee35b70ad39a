// Options from the parser, files from the manifest.
#include "cli/bake_key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string_view>

#include "brdf/simd/dispatch.h"
#include "cli/version.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

// Those that decide nothing, and the names of files whose contents are in the key.
constexpr std::array<std::string_view, 14> kUndecisive{"help",    "version", "stack",      "output",  "json",
                                                       "quiet",   "threads", "force",      "memory",  "spill",
                                                       "timings", "fresh",   "stop-after", "lobe-set"};

io::Json options_of(const CLI::App& parser) {
  io::Json json = io::Json::object();
  for (const CLI::Option* option : parser.get_options()) {
    const std::string name = option->get_single_name();
    if (std::ranges::find(kUndecisive, name) != kUndecisive.end()) continue;
    json["--" + name] = option->count() > 0 ? fmt::format("{}", fmt::join(option->reduced_results(), " "))
                                            : option->get_default_str();
  }
  return json;
}

std::string state_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  const auto time = error ? fs::file_time_type() : fs::last_write_time(file, error);
  if (error) {
    throw io::IoError(io::IoError::Side::kInput, file.string(), "cannot be read: " + error.message(),
                      "a file that can be read");
  }
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch());
  return fmt::format("{} bytes, {} ns", size, since.count());
}

io::Json inputs_of(const io::StackSource& source) {
  io::Json json = io::Json::object();
  const fs::path folder = source.file.parent_path();
  const auto add = [&](const std::optional<fs::path>& file) {
    if (!file) return;
    const fs::path relative = file->lexically_relative(folder);
    json[relative.empty() ? file->string() : relative.string()] = state_of(*file);
  };
  for (const io::StackPicture& picture : source.pictures) {
    add(picture.file);
    add(picture.weight);
    add(picture.shadow);
  }
  for (const auto& file : {source.dark, source.flat, source.mask, source.normals, source.albedo}) add(file);
  return json;
}

std::string text_of(const io::Json& object, const std::string& name) {
  return object.is_object() && object.contains(name) && object[name].is_string()
             ? object[name].get<std::string>()
             : "";
}

// The first member, of either, that differs.
std::string changed_member(const io::Json& now, const io::Json& before) {
  for (const io::Json& one : {now, before}) {
    for (const auto& [name, value] : one.items()) {
      if (text_of(now, name) != text_of(before, name)) return name;
    }
  }
  return "";
}

std::string or_nothing(const std::string& value) {
  return value.empty() ? "not given" : value;
}

}  // namespace

io::Json bake_key(const CLI::App& parser, const BakeArguments& a, const io::StackSource& source) {
  io::Json key;
  key["version"] = kVersion;
  key["instructions"] = simd::name_of(simd::best_isa());
  key["stack"] = io::sha256_of_file(source.file);
  key["lobe_set"] = a.lobe_set.empty() ? "" : io::sha256_of_file(a.lobe_set);
  key["options"] = options_of(parser);
  key["inputs"] = inputs_of(source);
  return key;
}

std::string difference_of_keys(const io::Json& now, const io::Json& before) {
  if (now == before) return "";
  if (!before.is_object() || !before.contains("options") || !before.contains("inputs")) {
    return "it does not say what it is of";
  }
  const std::string option = changed_member(now["options"], before["options"]);
  const std::string input = changed_member(now["inputs"], before["inputs"]);
  if (text_of(now, "version") != text_of(before, "version")) {
    return fmt::format("brdfit is {} and was {}", text_of(now, "version"), text_of(before, "version"));
  }
  if (text_of(now, "instructions") != text_of(before, "instructions")) return "this is another machine";
  if (!option.empty()) {
    return fmt::format("{} is {} and was {}", option, or_nothing(text_of(now["options"], option)),
                       or_nothing(text_of(before["options"], option)));
  }
  if (text_of(now, "stack") != text_of(before, "stack")) return "the stack's description has changed";
  if (text_of(now, "lobe_set") != text_of(before, "lobe_set")) return "the lobe set has changed";
  if (!input.empty()) return input + " has changed";
  return "it is of another bake";
}

}  // namespace brdfit::cli

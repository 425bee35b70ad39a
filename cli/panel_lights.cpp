// Lights by word, by name and by place.
#include "cli/panel_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

#include "cli/common.h"

namespace brdfit::cli {
namespace {

constexpr std::array<const char*, 3> kErrorWords = {"worst", "median", "best"};

std::string stem_of(const std::string& name) {
  return std::filesystem::path(name).stem().string();
}

bool is_error_word(const std::string& word) {
  return std::find(kErrorWords.begin(), kErrorWords.end(), word) != kErrorWords.end();
}

std::uint32_t light_of_word(const std::string& word, std::span<const double> errors) {
  if (errors.empty()) {
    throw UsageError(
        fmt::format("--panels {}: held-out errors say which, and --no-evidence leaves them out", word));
  }
  std::vector<std::uint32_t> order(errors.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return errors[a] < errors[b]; });
  if (word == "best") return order.front();
  return word == "worst" ? order.back() : order[order.size() / 2];
}

std::optional<std::uint32_t> place_of(const std::string& text, std::size_t count) {
  std::uint32_t place = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), place);
  if (error != std::errc{} || end != text.data() + text.size() || place >= count) return std::nullopt;
  return place;
}

std::uint32_t light_of_name(const std::string& asked, std::span<const std::string> names) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t k = 0; k < names.size(); ++k) {
    if (names[k] == asked) return k;
    if (stem_of(names[k]) == asked || std::filesystem::path(names[k]).filename() == asked) found.push_back(k);
  }
  if (found.size() > 1) {
    throw UsageError(
        fmt::format("--panels {}: {} and {} have this name", asked, names[found[0]], names[found[1]]));
  }
  if (!found.empty()) return found[0];
  if (const auto place = place_of(asked, names.size())) return *place;
  throw UsageError(
      fmt::format("--panels {} is no picture of the stack ({} ... {}, or 0 to {}), nor worst, "
                  "median, best or all",
                  asked, names.front(), names.back(), names.size() - 1));
}

// Names that differ in their ending or folder alone get their place too.
std::string file_of(std::uint32_t light, std::span<const std::string> names) {
  const std::string stem = stem_of(names[light]);
  const auto same = std::count_if(names.begin(), names.end(),
                                  [&](const std::string& name) { return stem_of(name) == stem; });
  return same > 1 ? fmt::format("{}-{}.png", stem, light) : stem + ".png";
}

}  // namespace

bool needs_errors(std::span<const std::string> asked) {
  return std::any_of(asked.begin(), asked.end(), is_error_word);
}

std::vector<PanelLight> panel_lights(std::span<const std::string> asked, std::span<const std::string> names,
                                     std::span<const double> errors) {
  std::map<std::uint32_t, std::vector<std::string>> chosen;
  for (const std::string& word : asked) {
    if (word == "all") {
      for (std::uint32_t k = 0; k < names.size(); ++k) chosen[k];
    } else if (is_error_word(word)) {
      std::vector<std::string>& words = chosen[light_of_word(word, errors)];
      if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
    } else {
      chosen[light_of_name(word, names)];
    }
  }
  std::vector<PanelLight> lights;
  for (auto& [light, words] : chosen) lights.push_back({light, file_of(light, names), std::move(words)});
  return lights;
}

}  // namespace brdfit::cli

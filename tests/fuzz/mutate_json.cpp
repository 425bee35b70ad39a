// Mutations of JSON that keep it JSON, beside those of bytes: a value replaced, a member dropped, moved or
// given another's value.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

using Json = nlohmann::ordered_json;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (auto& member : value) collect(member, all);
}

class Mutation {
 public:
  explicit Mutation(unsigned seed) : random_(seed) {}

  void apply(Json& root) {
    std::vector<Json*> all;
    collect(root, all);
    Json& chosen = *all[below(all.size())];
    switch (below(5)) {
      case 0:
        chosen = odd_value(chosen);
        break;
      case 1:
        chosen = Json(*all[below(all.size())]);
        break;
      case 2:
        if (!chosen.empty() && chosen.is_structured()) drop(chosen);
        break;
      case 3:
        if (chosen.is_array() && !chosen.empty()) chosen.push_back(Json(chosen[below(chosen.size())]));
        break;
      default:
        change_scalar(chosen);
    }
  }

 private:
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  // Mostly of the kind that is there: what is of another kind is refused early.
  Json odd_value(const Json& like) {
    static const std::vector<Json> numbers = {0,     1,      -1,      0.5,  2,         64,         33,
                                              1e308, 1e-320, -0.0,    1e9,  1e-9,      1e-160,     90,
                                              180,   1e6,    1000000, 4096, INT64_MAX, UINT64_MAX, INT64_MIN};
    static const std::vector<Json> texts = {"",    "a",   "a.png", "lambert", "../a",
                                            "a/b", "a\n", "rgb",   "1e-300"};
    static const std::vector<Json> others = {true,           false,          nullptr,       Json::array(),
                                             Json::object(), {0, 0, 1},      {0.6, 0, 0.8}, {0, 0, -1},
                                             {1e-200, 1, 1}, {1e9, 1e9, 1e9}};
    const bool same_kind = below(8) != 0;
    const std::vector<Json>& values = same_kind && like.is_number()   ? numbers
                                      : same_kind && like.is_string() ? texts
                                                                      : others;
    return values[below(values.size())];
  }

  void drop(Json& value) {
    value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(below(value.size()))));
  }

  void change_scalar(Json& value) {
    if (value.is_number()) {
      const double factors[] = {-1.0, 0.0, 0.5, 2.0, 1.001, 1e-6, 1e6};
      value = value.get<double>() * factors[below(std::size(factors))];
    } else if (value.is_boolean()) {
      value = !value.get<bool>();
    } else if (value.is_string()) {
      std::string text = value.get<std::string>();
      text.insert(below(text.size() + 1), 1, static_cast<char>(below(128)));
      value = text;
    }
  }

  std::minstd_rand random_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  Json value = Json::parse(data, data + size, nullptr, false);
  if (value.is_discarded()) return LLVMFuzzerMutate(data, size, max_size);
  Mutation mutation(seed);
  mutation.apply(value);
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

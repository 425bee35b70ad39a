// Sentences from points.
#include "cli/cost/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <set>

#include "cli/cost/error_keys.h"
#include "cli/cost/pareto.h"

namespace brdfit::cli {
namespace {

// Percentages next to 100 need a digit more to differ from it.
std::string percent(double value) {
  return fmt::format("{:.{}f}%", value, std::abs(value - 100.0) < 1.0 && value != 100.0 ? 1 : 0);
}

std::string times(double ratio) {
  if (ratio >= 10.0) return fmt::format("{:.0f}x", ratio);
  return fmt::format("{:.{}f}x", ratio, ratio >= 1.0 ? 1 : 2);
}

std::string with_unit(double value, const char* unit) {
  return fmt::format("{:.3g} {}", value, unit);
}

// "4,000".
std::string number(double value) {
  std::string text = fmt::format("{:g}", value);
  if (value != std::floor(value) || value >= 1e15) return text;
  text = fmt::format("{:.0f}", value);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), 1, ',');
  }
  return text;
}

// Half the width of a median's interval of about 95%: the notch of a box plot (McGill, Tukey and Larsen
// 1978).
double notch(const RepeatedTime& time) {
  return 1.57 * (time.high_quartile - time.low_quartile) / std::sqrt(static_cast<double>(time.repeats));
}

bool are_alike(const RepeatedTime& a, const RepeatedTime& b) {
  return std::abs(a.median - b.median) <= notch(a) + notch(b);
}

// Positive numbers only: a 0 is a word for "as many as fit".
std::optional<double> positive_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0)) return std::nullopt;
  return value;
}

std::set<std::string> words_of(const std::string& list) {
  std::set<std::string> words;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    words.insert(list.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

class Writer {
 public:
  explicit Writer(const CostRun& run) : run_(run), making_(run.kind == "stack" ? "bake" : "fit") {
    for (const CostPoint& point : run.points) {
      if (point.sweep == "default" && default_ == nullptr) default_ = &point;
      if (point.sweep == "device" || std::isnan(error(point))) continue;
      if (best_ == nullptr || error(point) < error(*best_)) best_ = &point;
    }
  }

  std::vector<Finding> write() {
    if (best_ == nullptr) return {};
    say_best();
    say_front("run time", &CostPoint::on_run_front, &CostPoint::evaluation_ns, "its run-time cost",
              "ns an evaluation");
    say_front(fmt::format("time to {}", making_), &CostPoint::on_make_front, &CostPoint::make_seconds,
              fmt::format("its time to {}", making_), "s");
    if (default_ != nullptr) say_sweeps();
    say_held_out();
    return std::move(findings_);
  }

 private:
  double error(const CostPoint& point) const { return error_of(point, run_.leading_error); }

  void add(const std::string& about, const std::string& text, const std::vector<const CostPoint*>& points) {
    Finding finding = {about, text, {}};
    for (const CostPoint* point : points) finding.points.push_back(point->name);
    findings_.push_back(std::move(finding));
  }

  // "at 0.40x its run-time cost"; "" where one of the two was not measured.
  static std::string ratio_text(const RepeatedTime& a, const RepeatedTime& b, const std::string& what) {
    if (!a.is_measured() || !b.is_measured()) return "";
    if (are_alike(a, b)) return fmt::format("about {}", what);
    return fmt::format("{} {}", times(a.median / b.median), what);
  }

  // "A reaches 94% of the accuracy of B at 0.40x its run-time cost and 0.70x its time to fit."
  std::string comparison(const CostPoint& a, const CostPoint& b) const {
    std::string text = fmt::format("{} reaches {} of the accuracy of {}", a.name,
                                   percent(accuracy_share_pct(error(a), error(b))), b.name);
    const std::string run_time = ratio_text(a.evaluation_ns, b.evaluation_ns, "its run-time cost");
    const std::string making =
        ratio_text(a.make_seconds, b.make_seconds, fmt::format("its time to {}", making_));
    if (!run_time.empty() || !making.empty()) text += " at ";
    text += run_time;
    if (!run_time.empty() && !making.empty()) text += " and ";
    return text + making + ".";
  }

  void say_best() {
    std::string text = fmt::format("The least error, {:.3g} ({}), is that of {}", error(*best_),
                                   error_title(run_.leading_error), best_->name);
    if (best_->evaluation_ns.is_measured())
      text += fmt::format(", {} an evaluation", with_unit(best_->evaluation_ns.median, "ns"));
    if (best_->make_seconds.is_measured())
      text += fmt::format(", {} to {}", with_unit(best_->make_seconds.median, "s"), making_);
    add("best", text + ".", {best_});
  }

  // The cheapest points of a front that reach shares of the best accuracy.
  void say_front(const std::string& about, bool CostPoint::*is_on_front, RepeatedTime CostPoint::*time,
                 const std::string& what, const char* unit) {
    const CostFigure cost = [time](const CostPoint& point) { return (point.*time).median; };
    const std::vector<std::size_t> front = by_cost(run_.points, is_on_front, cost);
    const CostPoint* said = best_;
    for (const double share : {50.0, 75.0, 90.0, 99.0}) {
      const auto found = std::ranges::find_if(front, [&](std::size_t k) {
        return accuracy_share_pct(error(run_.points[k]), error(*best_)) >= share;
      });
      if (found == front.end()) continue;
      const CostPoint& point = run_.points[*found];
      if (&point == said || &point == best_ || !(best_->*time).is_measured()) continue;
      said = &point;
      add(about,
          fmt::format("For {} of the accuracy of {} pay {}: {} ({} of it, {}).", percent(share), best_->name,
                      ratio_text(point.*time, best_->*time, what), point.name,
                      percent(accuracy_share_pct(error(point), error(*best_))),
                      with_unit((point.*time).median, unit)),
          {&point, best_});
    }
  }

  std::vector<const CostPoint*> points_of(const std::string& sweep) const {
    std::vector<const CostPoint*> points;
    for (const CostPoint& point : run_.points) {
      if (point.sweep == sweep && !std::isnan(error(point))) points.push_back(&point);
    }
    return points;
  }

  void say_sweeps() {
    std::vector<std::string> sweeps;
    for (const CostPoint& point : run_.points) {
      // Points that vary several choices at once are there for the fronts.
      const bool is_one_choice = point.sweep != "default" && point.sweep.find(',') == std::string::npos;
      if (is_one_choice && std::ranges::find(sweeps, point.sweep) == sweeps.end()) {
        sweeps.push_back(point.sweep);
      }
    }
    for (const std::string& sweep : sweeps) {
      if (sweep == "device") {
        say_devices();
      } else if (sweep == "effects") {
        say_effects();
      } else if (sweep == "loss") {
        say_losses();
      } else {
        say_choices(sweep);
      }
    }
  }

  // Of what more is better, if anything: not of a ridge.
  static bool is_amount(const std::string& sweep) {
    return sweep == "samples" || sweep == "starts" || sweep == "lobes";
  }

  // A plateau of amounts, and each other choice against the default.
  void say_choices(const std::string& sweep) {
    const std::optional<Plateau> plateau =
        is_amount(sweep) ? plateau_of(run_, sweep) : std::optional<Plateau>();
    if (plateau) say_plateau(sweep, *plateau);
    for (const CostPoint* point : points_of(sweep)) {
      if (!plateau || !positive_number(setting_of(*point, sweep)))
        add(sweep, comparison(*point, *default_), {point, default_});
    }
  }

  void say_plateau(const std::string& sweep, const Plateau& plateau) {
    const CostPoint& point = run_.points[plateau.point];
    const CostPoint& last = run_.points[plateau.last];
    if (&point == &last) {
      add(sweep,
          fmt::format("The error still falls by more than {} at {} {}, the most that were tried.",
                      percent(100.0 * kNoImprovement), number(plateau.largest), sweep),
          {&last});
      return;
    }
    std::string text = fmt::format("After {} {} nothing improves by more than {}", number(plateau.value),
                                   sweep, percent(100.0 * kNoImprovement));
    const std::string ratio =
        ratio_text(last.make_seconds, point.make_seconds, fmt::format("as long to {}", making_));
    if (!ratio.empty()) text += fmt::format("; {} take {}", number(plateau.largest), ratio);
    add(sweep, text + ".", {&point, &last});
  }

  // Whether two points differ in nothing but one setting.
  static bool differ_in_only(const CostPoint& a, const CostPoint& b, const std::string& key) {
    return std::ranges::equal(a.settings, b.settings, [&](const auto& x, const auto& y) {
      return x.first == y.first && (x.first == key || x.second == y.second);
    });
  }

  void say_effects() {
    std::vector<const CostPoint*> points;
    std::set<std::string> all;
    for (const CostPoint* point : points_of("effects")) {
      if (!differ_in_only(*point, *default_, "effects")) continue;
      const std::string effects = setting_of(*point, "effects");
      if (effects == "auto" || effects == "none") {
        add("effects", comparison(*point, *default_), {point, default_});
        continue;
      }
      points.push_back(point);
      all.merge(words_of(effects));
    }
    for (const CostPoint* point : points) {
      std::set<std::string> missing = all;
      for (const std::string& word : words_of(setting_of(*point, "effects"))) missing.erase(word);
      if (missing.size() == 1) say_effect(*missing.begin(), *point);
    }
  }

  // What leaving one effect out does.
  void say_effect(const std::string& effect, const CostPoint& without) {
    const double rise = error(without) / error(*default_) - 1.0;
    const std::string cost = ratio_text(without.evaluation_ns, default_->evaluation_ns, "the run-time cost");
    if (!std::isfinite(rise)) return;
    if (std::abs(rise) <= kNoImprovement) {
      add("effects",
          fmt::format("{} is worth nothing here: without it the error changes by no more than {}{}.", effect,
                      percent(100.0 * kNoImprovement), cost.empty() ? cost : fmt::format(", at {}", cost)),
          {&without, default_});
      return;
    }
    add("effects",
        fmt::format("Without {} the error is {} {}{}.", effect, percent(100.0 * std::abs(rise)),
                    rise > 0.0 ? "higher" : "lower", cost.empty() ? cost : fmt::format(", at {}", cost)),
        {&without, default_});
  }

  void say_losses() {
    std::vector<const CostPoint*> points = {default_};
    for (const CostPoint* point : points_of("loss")) {
      if (setting_of(*point, "loss") == "auto") {
        add("loss", comparison(*point, *default_), {point, default_});
      } else {
        points.push_back(point);
      }
    }
    std::ranges::stable_sort(points, {}, [&](const CostPoint* point) { return error(*point); });
    const CostPoint& least = *points.front();
    const CostPoint& most = *points.back();
    if (!(error(least) < error(most))) return;
    add("loss",
        fmt::format("Of the losses {} leaves the least error, {:.3g}, and {} the most, {:.3g}.",
                    setting_of(least, "loss"), error(least), setting_of(most, "loss"), error(most)),
        {&least, &most});
  }

  // "in float on processor"; the device alone where that says it all.
  static std::string evaluator_of(const CostPoint& point) {
    const std::string scalar = setting_of(point, "scalar");
    return fmt::format("{}on {}", scalar.empty() ? scalar : fmt::format("in {} ", scalar),
                       setting_of(point, "device"));
  }

  void say_devices() {
    const std::vector<const CostPoint*> points = points_of("device");
    for (const CostPoint* point : points) {
      const CostPoint& first = *points.front();
      if (point == &first || !point->evaluation_ns.is_measured() || !first.evaluation_ns.is_measured())
        continue;
      const double change = error(first) > 0.0 ? std::abs(error(*point) / error(first) - 1.0) : 0.0;
      add("device",
          fmt::format("An evaluation {} takes {} that {}; the error {}.", evaluator_of(*point),
                      ratio_text(point->evaluation_ns, first.evaluation_ns, "the time of"),
                      evaluator_of(first),
                      change > 0.0 ? fmt::format("differs by {:.1g}% of it", 100.0 * change) : "is the same"),
          {point, &first});
    }
  }

  // Whether the best is the best where nothing of a fit has looked.
  void say_held_out() {
    constexpr const char* kHeldOut = "held_out_log_ratio_pct";
    const CostPoint* least = nullptr;
    for (const CostPoint& point : run_.points) {
      const double value = error_of(point, kHeldOut);
      if (!std::isnan(value) && (least == nullptr || value < error_of(*least, kHeldOut))) least = &point;
    }
    if (least == nullptr || std::isnan(error_of(*best_, kHeldOut))) return;
    const std::string where =
        fmt::format("On blocks of angles that nothing of a fit saw ({})", error_title(kHeldOut));
    if (least == best_) {
      add("held out",
          fmt::format("{} {} has the least error as well, {:.3g}.", where, best_->name,
                      error_of(*best_, kHeldOut)),
          {best_});
      return;
    }
    add("held out",
        fmt::format("{} {} has the least error, {:.3g}, and {} has {:.3g}.", where, least->name,
                    error_of(*least, kHeldOut), best_->name, error_of(*best_, kHeldOut)),
        {least, best_});
  }

  const CostRun& run_;
  std::string making_;
  const CostPoint* default_ = nullptr;
  const CostPoint* best_ = nullptr;
  std::vector<Finding> findings_;
};

}  // namespace

double accuracy_share_pct(double error_a, double error_b) {
  if (error_a == error_b) return 100.0;
  return 100.0 * error_b / error_a;
}

std::optional<Plateau> plateau_of(const CostRun& run, const std::string& sweep) {
  struct Tried {
    double value;
    double error;
    std::size_t point;
  };
  std::vector<Tried> tried;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    const CostPoint& point = run.points[k];
    if (point.sweep != sweep && point.sweep != "default") continue;
    const std::optional<double> value = positive_number(setting_of(point, sweep));
    const double error = error_of(point, run.leading_error);
    if (value && !std::isnan(error)) tried.push_back({*value, error, k});
  }
  if (tried.size() < 2) return std::nullopt;
  std::ranges::stable_sort(tried, {}, &Tried::value);
  const auto is_enough = [&](const Tried& one) {
    return std::ranges::all_of(tried, [&](const Tried& other) {
      return other.value <= one.value || one.error - other.error <= kNoImprovement * one.error;
    });
  };
  const Tried& found = *std::ranges::find_if(tried, is_enough);
  return Plateau{found.value, tried.back().value, found.point, tried.back().point};
}

std::vector<Finding> findings_of(const CostRun& run) {
  return Writer(run).write();
}

std::vector<std::string> sentences_of(const std::vector<Finding>& findings) {
  std::vector<std::string> texts;
  for (const Finding& finding : findings) texts.push_back(finding.text);
  return texts;
}

}  // namespace brdfit::cli

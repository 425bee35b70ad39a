// The picture of detection over strength.
#ifndef BRDFIT_BENCH_DETECTION_PICTURE_H_
#define BRDFIT_BENCH_DETECTION_PICTURE_H_

#include <string>
#include <vector>

namespace brdfit::bench {

// So many of n trials, with the 95% interval of the share by Wilson (1927).
struct Share {
  double from = 0.0;  // strengths; both 0 where there is no range
  double to = 0.0;
  int n = 0;
  int found = 0;

  double share() const { return n > 0 ? static_cast<double>(found) / n : 0.0; }
  // Exact at the ends, where the formula only rounds to them.
  double lower() const { return found == 0 ? 0.0 : middle() - half(); }
  double upper() const { return found == n ? 1.0 : middle() + half(); }

 private:
  double middle() const;
  double half() const;
};

struct Curve {
  std::string name;
  std::vector<Share> bins;
};

// A whole SVG file: share of trials that found the group, over strength on a logarithmic axis.
std::string detection_picture(const std::vector<Curve>& curves);

}  // namespace brdfit::bench

#endif  // BRDFIT_BENCH_DETECTION_PICTURE_H_

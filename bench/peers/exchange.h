// What the comparison with peers hands from program to program: plain text, numbers that come back bit for
// bit.
//
// DIR/samples.txt, one sampled cell of the table a line: cell wi.x wi.y wi.z wo.x wo.y wo.z r g b, with unit
// directions in the local frame (z = n) and f in sr^-1. DIR/NAME.values.txt: the seconds of the fit, then for
// each sample in the same order r g b of f(wi, wo) and of f(wo, wi). It needs nothing of brdfit, so that
// peers are built without it.
#ifndef BRDFIT_BENCH_PEERS_EXCHANGE_H_
#define BRDFIT_BENCH_PEERS_EXCHANGE_H_

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <locale>
#include <stdexcept>
#include <string>
#include <vector>

namespace peers {

using Triple = std::array<double, 3>;

struct Sample {
  std::size_t cell = 0;
  Triple wi{}, wo{}, f{};
};

struct Values {
  Triple f{};        // f(wi, wo)
  Triple swapped{};  // f(wo, wi)
};

inline std::istream& operator>>(std::istream& in, Triple& t) {
  return in >> t[0] >> t[1] >> t[2];
}
inline std::ostream& operator<<(std::ostream& out, const Triple& t) {
  return out << t[0] << ' ' << t[1] << ' ' << t[2];
}

inline std::string samples_file(const std::string& folder) {
  return folder + "/samples.txt";
}
inline std::string values_file(const std::string& folder, const std::string& name) {
  return folder + "/" + name + ".values.txt";
}

template <class Stream>
Stream open(const std::string& file) {
  Stream stream(file);
  if (!stream) throw std::runtime_error(file + " cannot be opened");
  stream.imbue(std::locale::classic());
  stream.precision(std::numeric_limits<double>::max_digits10);
  return stream;
}

inline std::vector<Sample> read_samples(const std::string& folder) {
  auto in = open<std::ifstream>(samples_file(folder));
  std::vector<Sample> samples;
  for (Sample s; in >> s.cell >> s.wi >> s.wo >> s.f;) samples.push_back(s);
  if (samples.empty() || !in.eof()) throw std::runtime_error(samples_file(folder) + " holds no samples");
  return samples;
}

inline void write_samples(const std::string& folder, const std::vector<Sample>& samples) {
  auto out = open<std::ofstream>(samples_file(folder));
  for (const Sample& s : samples) out << s.cell << ' ' << s.wi << ' ' << s.wo << ' ' << s.f << '\n';
}

// What is not finite as a negative number: streams write such values and do not read them.
inline Triple readable(Triple f) {
  for (double& v : f) {
    if (!std::isfinite(v)) v = -1.0;
  }
  return f;
}

// eval(wi, wo) gives f as a Triple.
template <class Eval>
void write_values(const std::string& folder, const std::string& name, double seconds, const Eval& eval) {
  auto out = open<std::ofstream>(values_file(folder, name));
  out << seconds << '\n';
  for (const Sample& s : read_samples(folder)) {
    out << readable(eval(s.wi, s.wo)) << ' ' << readable(eval(s.wo, s.wi)) << '\n';
  }
  if (!out.flush()) throw std::runtime_error(values_file(folder, name) + " cannot be written");
}

inline std::vector<Values> read_values(const std::string& folder, const std::string& name, double& seconds) {
  auto in = open<std::ifstream>(values_file(folder, name));
  std::vector<Values> values;
  in >> seconds;
  for (Values v; in >> v.f >> v.swapped;) values.push_back(v);
  if (!in.eof()) throw std::runtime_error(values_file(folder, name) + " holds something else than numbers");
  return values;
}

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace peers

#endif  // BRDFIT_BENCH_PEERS_EXCHANGE_H_

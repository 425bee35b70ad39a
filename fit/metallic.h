// Whether a measurement can tell a metal from a dielectric.
#ifndef BRDFIT_FIT_METALLIC_H_
#define BRDFIT_FIT_METALLIC_H_

#include <string>

#include "fit/explore.h"
#include "fit/problem.h"

namespace brdfit::fit {

// A candidate, and what was found about its metallic.
struct Decided {
  Candidate candidate;
  std::string note;                 // a sentence for the result; empty where there is nothing to say
  bool metallic_undecided = false;  // metallic 0 fits as well, and was kept
  int evaluations = 0;
};

// Metallic splits the base colour between diffuse and specular, and a low metallic does what specular does.
// So a candidate that moved it is searched again without: if that is as good (a loss up to 1% higher), the
// simpler material is kept. If it is not, but f0 is below that of any bare metal, the note says that metallic
// stands in for something else. Only a loss three times as high counts as told apart. Fixed metallic is left
// alone.
Decided decide_metallic(const Problem& problem, const Candidate& candidate);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_METALLIC_H_

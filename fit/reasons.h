// Why parameters are unidentifiable, in words.
#ifndef BRDFIT_FIT_REASONS_H_
#define BRDFIT_FIT_REASONS_H_

#include <span>
#include <string>
#include <vector>

#include "fit/identifiability.h"

namespace brdfit::fit {

// A reason for every free number that is unidentifiable in `now`, in the order of the parametrisation; empty
// for others. x: the numbers now. before: the evidence with everything free, whose unseen directions say what
// is tied to what.
std::vector<std::string> reasons_of(const Parametrisation& parametrisation, std::span<const double> x,
                                    const Identifiability& before, const Identifiability& now);

// "metallic and specular" of two public names, "a, b and c" of three; underscores become spaces.
std::string in_words(const std::vector<std::string>& names);

// Gives every unidentifiable public parameter a reason: that of its numbers, or of its own where these are
// known (a tint of nothing).
void add_reasons(const Parametrisation& parametrisation, std::span<const double> x,
                 const std::vector<std::string>& reasons, std::vector<ParameterState>& states);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_REASONS_H_

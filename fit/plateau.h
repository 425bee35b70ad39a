// Where a descent stays although it need not: a flat part of a residual.
#ifndef BRDFIT_FIT_PLATEAU_H_
#define BRDFIT_FIT_PLATEAU_H_

#include <vector>

#include "fit/parameters.h"

namespace brdfit::fit {

// A second lobe as rough as can be, which is where roughness times scale is 1 or more, does not change with
// its scale: a descent that gets there stays. Takes the scale back to where it counts. Returns whether it was
// beyond; false where roughness or scale is not free.
bool leave_plateau(const Parametrisation& parametrisation, std::vector<double>& x);

// Descends; and again from off the plateau if that is where it ends. The better end is kept, and both are
// paid for. state: has a Solution `solution`. descend(state): moves it.
template <class State, class Descend>
void descend_past_plateau(const Parametrisation& parametrisation, State& state, Descend&& descend) {
  descend(state);
  State other = state;
  if (!leave_plateau(parametrisation, other.solution.x)) return;
  descend(other);
  state.solution.evaluations = other.solution.evaluations;
  if (other.solution.cost < state.solution.cost) state = other;
}

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_PLATEAU_H_

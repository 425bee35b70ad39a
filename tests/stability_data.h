// The hard tables, fits and sets of lobes that docs/stability.md lists.
#ifndef BRDFIT_TESTS_STABILITY_DATA_H_
#define BRDFIT_TESTS_STABILITY_DATA_H_

#include <functional>
#include <string>
#include <vector>

namespace brdfit::stability {

struct DataCase {
  std::string id;
  std::function<void()> run;  // fails the running test where it does not end well
};

const std::vector<DataCase>& fit_cases();
const std::vector<DataCase>& realis_cases();

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_DATA_H_

#include "bake/lobes.h"

namespace brdfit::bake {

Eigen::MatrixXd lobe_values(const LobeSet& lobes, std::span<const Vec3> directions) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(directions.size()),
                         static_cast<Eigen::Index>(lobes.size()));
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      values(i, k) = eval(lobes[static_cast<std::size_t>(k)], directions[static_cast<std::size_t>(i)]);
    }
  }
  return values;
}

}  // namespace brdfit::bake

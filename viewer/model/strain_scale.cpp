#include <weft/viewer/model/strain_scale.hpp>

#include <cmath>

namespace weft::viewer {

void StrainScale::include(const std::vector<Eigen::VectorXd>& strains) {
  double largest = limit_;
  for (const Eigen::VectorXd& values : strains) {
    for (const double value : values) {
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
  }
  if (!(largest > limit_)) return;
  const double power = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
    limit_ = digit * power;
    if (largest <= limit_) return;
  }
}

scenes::ScalarField StrainScale::field(const std::vector<Eigen::VectorXd>& strains) const {
  scenes::ScalarField field;
  for (const Eigen::VectorXd& values : strains) field.values.push_back(100.0 * values);
  field.maximum = 100.0 * limit();
  field.minimum = -field.maximum;
  field.label = "strain [%]";
  return field;
}

}  // namespace weft::viewer

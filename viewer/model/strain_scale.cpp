#include <weft/viewer/model/strain_scale.hpp>

#include <algorithm>
#include <cmath>

namespace weft::viewer {
namespace {

constexpr double kShare = 0.99;  // of the nodes that the range holds
/// A range is far too large if so small a part of it would do.
constexpr double kFarTooLarge = 0.35;

double strain_of_most(const std::vector<Eigen::VectorXd>& strains) {
  std::vector<double> sizes;
  for (const Eigen::VectorXd& values : strains) {
    for (const double value : values) {
      if (std::isfinite(value)) sizes.push_back(std::abs(value));
    }
  }
  if (sizes.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
  return sizes[static_cast<std::size_t>(rank)];
}

double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (value <= digit * power) return digit * power;
  }
  return 10.0 * power;
}

}  // namespace

void StrainScale::include(const std::vector<Eigen::VectorXd>& strains) {
  const double largest = strain_of_most(strains);
  if (!(largest > 0.0)) return;
  num_small_ = largest < kFarTooLarge * limit_ ? num_small_ + 1 : 0;
  if (largest <= limit_ && num_small_ < kPatience) return;
  limit_ = round_up(largest);
  num_small_ = 0;
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

// The typed laws and the registry say the same.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/typed_laws.hpp>

namespace weft {
namespace {

/// Every typed law with nothing given.
std::vector<forces::LawSpecification> typed_laws() {
  return {
      laws::tension({}),
      laws::spring_damping({}),
      laws::torsion({}),
      laws::hinge_torsion({}),
      laws::nonlocal_torsion({}),
      laws::acceleration_damping({}),
      laws::rotation_damping({}),
      laws::torsional_rotation_damping({}),
      laws::velocity_damping({}),
      laws::wind({}),
      laws::pressure({}),
      laws::gravity({}),
      laws::drive({}),
  };
}

TEST(TypedLaws, AreTheLawsOfTheRegistry) {
  const std::vector<forces::LawSpecification> typed = typed_laws();
  const auto rows = forces::all_laws();
  ASSERT_EQ(typed.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    SCOPED_TRACE(rows[k]->id);
    EXPECT_EQ(typed[k].law, rows[k]->id);
    EXPECT_TRUE(typed[k].sets.empty());
    ASSERT_EQ(typed[k].parameters.size(), rows[k]->parameters.size());
    for (const forces::ParameterInfo& parameter : rows[k]->parameters) {
      SCOPED_TRACE(parameter.name);
      const auto found = typed[k].parameters.find(parameter.name);
      ASSERT_NE(found, typed[k].parameters.end());
      ASSERT_EQ(found->second.size(), static_cast<std::size_t>(parameter.size));
      for (const double value : found->second) {
        if (parameter.required) {
          EXPECT_TRUE(std::isnan(value));
        } else {
          EXPECT_EQ(value, parameter.default_value);
        }
      }
    }
  }
}

TEST(TypedLaws, HandOverValuesAndSets) {
  const forces::LawSpecification law =
      laws::tension({.stiffness = 2000.0, .compression_ratio = 0.5, .sets = {"shear"}});
  EXPECT_EQ(law.sets, std::vector<std::string>{"shear"});
  EXPECT_EQ(law.parameters.at("stiffness"), std::vector<double>{2000.0});
  EXPECT_EQ(law.parameters.at("compression_ratio"), std::vector<double>{0.5});
  EXPECT_EQ(laws::gravity({.acceleration = {0, -9.81, 0}}).parameters.at("acceleration"),
            (std::vector<double>{0, -9.81, 0}));
}

TEST(TypedLaws, AParameterThatIsNotGivenIsOneClearError) {
  try {
    (void)forces::checked(laws::tension({}));
    FAIL() << "no error";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "tension: stiffness = nan [N/m], expected a finite number");
  }
}

}  // namespace
}  // namespace weft

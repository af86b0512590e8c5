// Bad input to every law of the registry: one line that names the law, the parameter, its value
// and its unit.

#include <cmath>
#include <limits>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>

#include "tests/contract/dual/dual_laws.hpp"
#include "tests/contract/sample.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {
namespace {

using forces::LawInfo;
using forces::LawSpecification;
using forces::ParameterInfo;
using testing::HasSubstr;
using testing::Not;

const double kInfinity = std::numeric_limits<double>::infinity();
const double kNan = std::numeric_limits<double>::quiet_NaN();

ClothMesh mesh_for(const LawSpecification& specification) {
  const LawInfo* info = forces::find_law(specification.law);
  return battery_mesh(info != nullptr && info->traits.needs_closed_surface);
}

std::string error_of(const LawSpecification& specification) {
  try {
    (void)forces::make_law<double>(specification, mesh_for(specification));
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

class LawInput : public testing::TestWithParam<const LawInfo*> {
 protected:
  const LawInfo& info_ = *GetParam();
  const LawSpecification good_ = typical_specification(info_, true);

  LawSpecification with(const ParameterInfo& parameter, const std::vector<double>& values) const {
    LawSpecification specification = good_;
    specification.parameters[std::string(parameter.name)] = values;
    return specification;
  }
  void expect_named(const std::string& error, const ParameterInfo& parameter,
                    const std::string& value) const {
    EXPECT_THAT(error, HasSubstr(std::string(info_.id) + ": "));
    EXPECT_THAT(error, HasSubstr(std::string(parameter.name) + " = " + value));
    EXPECT_THAT(error, HasSubstr("[" + std::string(parameter.unit) + "]"));
    EXPECT_THAT(error, HasSubstr("expected"));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
};

INSTANTIATE_TEST_SUITE_P(Registry, LawInput,
                         testing::ValuesIn(forces::all_laws().begin(), forces::all_laws().end()),
                         [](const auto& info) { return std::string(info.param->id); });

TEST_P(LawInput, TypicalValuesAreAccepted) {
  EXPECT_NO_THROW((void)forces::make_law<float>(good_, mesh_for(good_)));
  EXPECT_NO_THROW((void)forces::make_law<double>(good_, mesh_for(good_)));
  EXPECT_NO_THROW((void)make_dual_law(good_, mesh_for(good_)));
}

TEST_P(LawInput, NonFiniteParametersAreRefused) {
  for (const ParameterInfo& parameter : info_.parameters) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      for (int place = 0; place < parameter.size; ++place) {
        std::vector<double> values(static_cast<std::size_t>(parameter.size), 0.5);
        values[static_cast<std::size_t>(place)] = bad;
        expect_named(error_of(with(parameter, values)), parameter,
                     std::isnan(bad) ? "" : (bad > 0 ? "inf" : "-inf"));
      }
    }
  }
}

TEST_P(LawInput, ValuesOutsideTheDomainAreRefused) {
  for (const ParameterInfo& parameter : info_.parameters) {
    if (parameter.size != 1) continue;
    const double below = parameter.minimum - 1.0;
    expect_named(error_of(with(parameter, {below})), parameter, "-1");
    if (parameter.maximum >= ParameterInfo{}.maximum) continue;
    expect_named(error_of(with(parameter, {parameter.maximum + 1.0})), parameter, "");
  }
}

TEST_P(LawInput, EndsOfTheDomainAreAccepted) {
  for (const ParameterInfo& parameter : info_.parameters) {
    if (parameter.size != 1) continue;
    EXPECT_EQ(error_of(with(parameter, {parameter.minimum})), "no error");
    EXPECT_EQ(error_of(with(parameter, {parameter.maximum})), "no error");
  }
}

TEST_P(LawInput, AFloatLawRefusesWhatFloatCannotHold) {
  for (const ParameterInfo& parameter : info_.parameters) {
    if (parameter.maximum < ParameterInfo{}.maximum) continue;
    const std::vector<double> values(static_cast<std::size_t>(parameter.size), 1e200);
    EXPECT_THROW((void)forces::make_law<float>(with(parameter, values), mesh_for(good_)),
                 InvalidArgument);
  }
}

TEST_P(LawInput, WrongNumberOfValuesIsRefused) {
  for (const ParameterInfo& parameter : info_.parameters) {
    for (const int size : {0, parameter.size + 1}) {
      const std::vector<double> values(static_cast<std::size_t>(size), 0.5);
      expect_named(error_of(with(parameter, values)), parameter, std::to_string(size) + " numbers");
    }
  }
}

TEST_P(LawInput, MissingParametersAreNamedWithTheirUnit) {
  for (const ParameterInfo& parameter : info_.parameters) {
    LawSpecification specification = good_;
    specification.parameters.erase(std::string(parameter.name));
    if (!parameter.required) {
      EXPECT_EQ(error_of(specification), "no error");
      continue;
    }
    const std::string error = error_of(specification);
    EXPECT_THAT(error, HasSubstr(std::string(info_.id) + ": "));
    EXPECT_THAT(error, HasSubstr("'" + std::string(parameter.name) + "'"));
    EXPECT_THAT(error, HasSubstr(std::string(parameter.unit)));
  }
}

TEST_P(LawInput, DefaultsLieInTheirDomain) {
  for (const ParameterInfo& parameter : info_.parameters) {
    if (parameter.required) continue;
    const std::vector<double> values(static_cast<std::size_t>(parameter.size),
                                     parameter.default_value);
    EXPECT_EQ(error_of(with(parameter, values)), "no error");
  }
}

TEST_P(LawInput, UnknownParametersAreRefusedAndTheKnownOnesListed) {
  LawSpecification specification = good_;
  specification.parameters["no_such_parameter"] = {1.0};
  const std::string error = error_of(specification);
  EXPECT_THAT(error, HasSubstr(std::string(info_.id) + ": "));
  EXPECT_THAT(error, HasSubstr("'no_such_parameter'"));
  for (const ParameterInfo& parameter : info_.parameters) {
    EXPECT_THAT(error, HasSubstr(std::string(parameter.name)));
  }
}

TEST_P(LawInput, UnknownSetsAreRefused) {
  LawSpecification specification = good_;
  specification.sets = {"no_such_set"};
  const std::string key(set_key(info_.traits.elements));
  EXPECT_THAT(error_of(specification),
              HasSubstr(std::string(info_.id) + ": " + (key.empty() ? "sets" : key)));
  EXPECT_THAT(error_of(specification), HasSubstr("'no_such_set'"));
}

TEST_P(LawInput, SetsNamedTwiceAreRefused) {
  const std::string key(set_key(info_.traits.elements));
  if (key.empty()) GTEST_SKIP() << "the law takes no sets";
  const std::string name = key == "edge_sets"   ? "shear"
                           : key == "line_sets" ? "lines_v"
                           : key == "node_sets" ? "region"
                                                : "ties";
  LawSpecification specification = good_;
  specification.sets = {name, name};
  EXPECT_THAT(error_of(specification), HasSubstr(std::string(info_.id) + ": " + key));
  EXPECT_THAT(error_of(specification), HasSubstr("'" + name + "'"));
}

TEST_P(LawInput, TheRowIsCompleteEnoughForDocumentation) {
  EXPECT_FALSE(info_.id.empty());
  EXPECT_FALSE(info_.summary.empty());
  EXPECT_FALSE(info_.formula.empty());
  EXPECT_FALSE(info_.source.empty());
  EXPECT_FALSE(info_.checked_by.empty());
  for (const ParameterInfo& parameter : info_.parameters) {
    EXPECT_FALSE(parameter.unit.empty()) << parameter.name;
    EXPECT_FALSE(parameter.summary.empty()) << parameter.name;
    EXPECT_THAT(std::string(info_.formula), HasSubstr(std::string(parameter.symbol)))
        << "the formula must use the symbol of " << parameter.name;
  }
}

template <class Scalar>
void expect_bad_node_is_reported(const LawSpecification& specification) {
  const ClothMesh mesh = mesh_for(specification);
  forces::LawSet<Scalar> laws;
  laws.add(forces::make_law<Scalar>(specification, mesh));
  const Sample<Scalar> good = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const int where : {0, 1, 2}) {
      Sample<Scalar> sample = good;
      if (where == 0) sample.positions(1, 3) = Scalar(bad);
      if (where == 1) sample.velocities(2, 3) = Scalar(bad);
      if (where == 2) sample.masses[3] = Scalar(bad);
      sample.positions(0, 7) = Scalar(kNan);  // a later one, not to be reported
      Matrix3X<Scalar> forces = Matrix3X<Scalar>::Ones(3, mesh.num_nodes());
      const forces::ForceReport report =
          laws.add_forces(sample.state(), forces::LawSet<Scalar>::VelocityLaws::kAsForces, forces);
      EXPECT_EQ(report.first_non_finite_node, 3);
      EXPECT_EQ(forces, (Matrix3X<Scalar>::Ones(3, mesh.num_nodes()))) << "nothing may be added";
    }
  }
}

TEST_P(LawInput, ANonFiniteStateIsReportedAndAddsNothing) {
  expect_bad_node_is_reported<float>(good_);
  expect_bad_node_is_reported<double>(good_);
}

TEST(LawInput, AnUnknownLawIsRefusedAndTheKnownOnesListed) {
  const std::string error = error_of({.law = "no_such_law", .sets = {}, .parameters = {}});
  EXPECT_THAT(error, HasSubstr("'no_such_law'"));
  for (const LawInfo* info : forces::all_laws()) {
    EXPECT_THAT(error, HasSubstr(std::string(info->id)));
  }
  EXPECT_EQ(forces::find_law("no_such_law"), nullptr);
}

TEST(LawInput, IdsAreUnique) {
  for (const LawInfo* info : forces::all_laws()) EXPECT_EQ(forces::find_law(info->id), info);
}

}  // namespace
}  // namespace weft::contract

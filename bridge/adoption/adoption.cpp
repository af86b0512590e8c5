#include <weft/bridge/adoption/adoption.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <weft/bridge/adoption/body_mesh.hpp>
#include <weft/bridge/adoption/suitable_body.hpp>
#include <weft/bridge/link_stiffness.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Fate = AdoptedProperty::Fate;

void check(const AdoptionSettings& settings) {
  const auto require = [](bool is_good, const char* name, double value, const char* expected) {
    if (is_good) return;
    throw InvalidArgument("adoption: " + std::string(name) + " = " + std::to_string(value) +
                          ", expected " + expected);
  };
  const double step = settings.time_step;
  require(step > 0 && std::isfinite(step), "time_step [s]", step, "> 0 and finite");
  const double stiffness = settings.stiffness.value_or(0);
  require(stiffness >= 0 && std::isfinite(stiffness), "stiffness [N/m]", stiffness,
          ">= 0 and finite");
}

std::string in_newtons_per_meter(double stiffness) {
  char text[40];
  (void)std::snprintf(text, sizeof text, "%.4g N/m", stiffness);
  return text;
}

/// h^2 times the square of the frequency at which gas or a volume to keep swings a body, by which explicit forces of the start
/// of a step begin to gain energy without the damping of Bullet's visits [-].
constexpr double kStiffestGas = 1;

/// Why Bullet's forces of pressure (kPR / V) and volume (kVC (V0 - V)), each times area and normal, are too stiff beside
/// implicit springs; nothing if they are not.
std::optional<std::string> reason_against_gas(const btSoftBody& body, double time_step) {
  const double keeping = body.m_pose.m_bvolume ? static_cast<double>(body.m_cfg.kVC) : 0;
  const double pressure = static_cast<double>(body.m_cfg.kPR);
  if (!(keeping > 0) && pressure == 0) return std::nullopt;
  const double volume = std::abs(static_cast<double>(body.getVolume()));
  VectorX<double> areas = VectorX<double>::Zero(body.m_nodes.size());
  for (int f = 0; f < body.m_faces.size(); ++f) {
    const auto& n = body.m_faces[f].m_n;
    const btVector3 cross = btCross(n[1]->m_x - n[0]->m_x, n[2]->m_x - n[0]->m_x);
    for (const btSoftBody::Node* const corner : n) {
      areas[corner - &body.m_nodes[0]] += static_cast<double>(cross.length()) / 6;
    }
  }
  double sum = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    sum += areas[i] * areas[i] * static_cast<double>(body.m_nodes[i].m_im);
  }
  const double gas = volume > 0 ? std::abs(pressure) / (volume * volume) : 0;
  const double stiffness = time_step * time_step * sum * (keeping + gas);
  if (stiffness <= kStiffestGas) return std::nullopt;
  char text[160];
  (void)std::snprintf(
      text, sizeof text,
      "its forces kVC = %g and kPR = %g are too stiff for explicit steps of %.4g s: "
      "%.3g [1], expected at most %g",
      static_cast<double>(body.m_cfg.kVC), pressure, time_step, stiffness, kStiffestGas);
  return text;
}

/// Stiffness of the springs in the place of the links of one material [N/m].
double stiffness_of(const LinkedEdges& links, const btSoftBody& body, double largest,
                    const AdoptionSettings& settings) {
  if (settings.stiffness && !links.is_bending) return *settings.stiffness;
  const double factor = std::clamp(static_cast<double>(links.material->m_kLST), 0.0, 1.0);
  if (factor == 1 || !(links.mean_reduced_mass > 0)) return largest;
  const LinkContext context{links.mean_reduced_mass, std::max(1, body.m_cfg.piterations),
                            settings.time_step};
  return std::min(largest, stiffness_from_link_factor(factor, context));
}

/// Links, as tension laws.
std::vector<forces::LawSpecification> map_links(const BodyMesh& mesh, const btSoftBody& body,
                                                const AdoptionSettings& settings,
                                                AdoptionReport& report) {
  const double unit = mesh.mesh.masses.mean() / (settings.time_step * settings.time_step);
  std::vector<forces::LawSpecification> laws;
  for (const LinkedEdges& links : mesh.links) {
    const std::string what = std::to_string(links.num_links) + " links of " + links.name;
    if (links.num_left_out > 0) {
      report.properties.push_back({std::to_string(links.num_left_out) + " links of " + links.name,
                                   Fate::kIgnored,
                                   "between the same nodes as another link, or without a length"});
    }
    if (links.num_links == 0) continue;
    const double largest = unit * (links.is_bending ? kStiffestBendingLink : kStiffestLink);
    const double stiffness = stiffness_of(links, body, largest, settings);
    std::string how = "springs of " + in_newtons_per_meter(stiffness);
    if (settings.stiffness && !links.is_bending) {
      how += ", as asked";
    } else if (stiffness == largest) {
      how += links.is_bending ? ", as much as folds" : ", as stiff as cloth";
    } else {
      how += ", what kLST = " + std::to_string(links.material->m_kLST) + " in " +
             std::to_string(std::max(1, body.m_cfg.piterations)) + " iterations and " +
             std::to_string(settings.time_step) + " s makes of a link";
    }
    report.properties.push_back({what, Fate::kMapped, how});
    laws.push_back({"tension", {links.name}, {{"stiffness", {stiffness}}}});
  }
  return laws;
}

void report_rest(const btSoftBody& body, AdoptionReport& report) {
  const btSoftBody::Config& config = body.m_cfg;
  std::vector<AdoptedProperty>& list = report.properties;
  const auto add = [&](bool is_there, std::string what, Fate fate, std::string how) {
    if (is_there) list.push_back({std::move(what), fate, std::move(how)});
  };
  add(true, std::to_string(body.m_nodes.size()) + " nodes", Fate::kKept,
      "masses, pins, velocities, forces and gravity act as before, changes in the next step");
  add(body.m_faces.size() > 0, std::to_string(body.m_faces.size()) + " faces", Fate::kKept,
      "drawing, contact with cloth, air");
  const int num_anchors = body.m_anchors.size() + body.m_deformableAnchors.size();
  add(num_anchors > 0, std::to_string(num_anchors) + " anchors", Fate::kMapped,
      "solved with the springs; influence is the part of the pull that the object gets");
  add(config.kPR != 0 || config.kVC != 0, "pressure kPR and volume kVC", Fate::kLeftToBullet,
      "forces of the start of the step");
  add(config.kDG != 0 || config.kLF != 0, "drag kDG and lift kLF", Fate::kLeftToBullet,
      "forces of the start of the step");
  add(true, "friction kDF and collision margin", Fate::kKept, "Coulomb's law, at the margin");
  add(config.kDP != 0, "damping kDP", Fate::kKept, "velocities, at the end of the step");
  add(true, "hardness kCHR and kKHR, iterations", Fate::kIgnored,
      "contacts and springs are solved to FastSettings::solver");
  add((config.collisions & btSoftBody::fCollision::VF_SS) != 0, "contact VF_SS", Fate::kMapped,
      "node against face, with the margins of both");
  add((config.collisions & btSoftBody::fCollision::SDF_RS) == 0, "contact with rigid objects",
      Fate::kIgnored, "the body has no flag SDF_RS");
}

/// Links are as long as the nodes are apart while laws are made of positions: what is put back is followed as a change.
class MeasuredLinks {
 public:
  explicit MeasuredLinks(btSoftBody& body) : body_(body) {
    for (int l = 0; l < body.m_links.size(); ++l) {
      btSoftBody::Link& link = body.m_links[l];
      rest_lengths_.push_back(link.m_rl);
      link.m_rl = (link.m_n[0]->m_x - link.m_n[1]->m_x).length();
    }
  }
  ~MeasuredLinks() {
    for (int l = 0; l < body_.m_links.size(); ++l) {
      body_.m_links[l].m_rl = rest_lengths_[static_cast<std::size_t>(l)];
    }
  }
  MeasuredLinks(const MeasuredLinks&) = delete;
  MeasuredLinks& operator=(const MeasuredLinks&) = delete;

 private:
  btSoftBody& body_;
  std::vector<btScalar> rest_lengths_;
};

}  // namespace

std::string_view name_of(AdoptedProperty::Fate fate) {
  switch (fate) {
    case Fate::kKept:
      return "kept";
    case Fate::kMapped:
      return "mapped";
    case Fate::kLeftToBullet:
      return "left to Bullet";
    case Fate::kIgnored:
      return "ignored";
  }
  return "";
}

std::string AdoptionReport::text() const {
  if (refusal) return "left to Bullet: " + *refusal + "\n";
  std::string lines;
  for (const AdoptedProperty& property : properties) {
    lines +=
        property.what + ": " + std::string(name_of(property.fate)) + ", " + property.how + "\n";
  }
  return lines;
}

AdoptionReport adopt(SoftBodySolver& solver, btSoftBody& body, const AdoptionSettings& settings) {
  check(settings);
  AdoptionReport report;
  report.refusal = reason_against_implicit(body);
  if (!report.refusal && body.m_links.size() == 0) report.refusal = "it has no links";
  if (!report.refusal) report.refusal = reason_against_gas(body, settings.time_step);
  if (report.refusal) return report;
  // Bullet would do so first in the next step. It will, and builds the tree of faces then: the flag stays.
  if (body.m_bUpdateRtCst) body.resetLinkRestLengths();
  const BodyMesh mesh = mesh_of(body);
  std::vector<forces::LawSpecification> laws = map_links(mesh, body, settings, report);
  if (laws.empty()) {
    report = {.refusal = "it has no link that a spring could stand in for", .properties = {}};
    return report;
  }
  laws.insert(laws.end(), settings.laws.begin(), settings.laws.end());
  {
    const MeasuredLinks measured(body);
    report.refusal = solver.attach_fast(body, mesh.mesh, laws, settings.fast);
  }
  if (report.refusal) {
    report.properties.clear();
    return report;
  }
  report_rest(body, report);
  report.cloth = solver.cloth(body);
  return report;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge

#include <weft/reference/solver.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/reference/contact/search_budget.hpp>

namespace weft::reference {

SpringSolver::SpringSolver(System system, SolverOptions options)
    : system_(std::make_unique<System>(std::move(system))),
      options_(options),
      contact_(make_contact_model(options.contact)) {
  check_system(*system_);
  for (Body& body : system_->bodies) {
    set_pinned_velocities(body.mesh, body.velocities);
    dynamics_.emplace_back(body);
    integrators_.push_back(make_integrator(options.integrator, options.settings));
    motion_.inverse_masses.push_back(dynamics_.back().inverse_masses());
  }
  motion_.bodies.resize(system_->bodies.size());
  motion_.mean_is_end = moves_with_end_velocity(options.integrator);
  blow_up_ = find_blow_up(*system_);
}

StepOutcome SpringSolver::step(double time_step) {
  if (!(time_step > 0.0 && std::isfinite(time_step))) {
    std::ostringstream message;
    message << "reference solver: time_step = " << time_step << " [s], expected > 0 and finite";
    throw InvalidArgument(message.str());
  }
  StepOutcome outcome;
  outcome.integration.inner_steps = 0;
  if (blow_up_) {
    outcome.blow_up = blow_up_;
    return outcome;
  }
  const bool is_due =
      options_.guard_interval > 0 && steps_since_estimate_ >= options_.guard_interval;
  if (!stability_ || is_due) {
    stability_ = stability();
    steps_since_estimate_ = 0;
  }
  ++steps_since_estimate_;
  outcome.stable_step = stability_->stable_step;
  outcome.substeps = num_substeps(options_.guard, *stability_, time_step);
  const double substep_size = time_step / outcome.substeps;
  outcome.is_step_stable = substep_size < outcome.stable_step;

  for (int i = 0; i < outcome.substeps && !blow_up_; ++i) {
    substep(time_ + i * substep_size, substep_size, outcome);
  }
  time_ += time_step;
  outcome.blow_up = blow_up_;
  return outcome;
}

void SpringSolver::replace_body(std::size_t index, Body body) {
  if (index >= system_->bodies.size()) {
    throw InvalidArgument("reference solver: body " + std::to_string(index) + ", expected 0 to " +
                          std::to_string(system_->bodies.size()) + " - 1");
  }
  System alone;
  alone.bodies.push_back(std::move(body));
  check_system(alone);
  Body& place = system_->bodies[index];
  place = std::move(alone.bodies.front());
  set_pinned_velocities(place.mesh, place.velocities);
  dynamics_[index] = BodyDynamics(place);
  integrators_[index] = make_integrator(options_.integrator, options_.settings);
  motion_.inverse_masses[index] = dynamics_[index].inverse_masses();
  motion_.bodies[index] = {};
  if (options_.guard != GuardPolicy::kReport) stability_.reset();
}

void SpringSolver::substep(double time, double time_step, StepOutcome& outcome) {
  motion_.time_step = time_step;
  for (std::size_t b = 0; b < dynamics_.size(); ++b) {
    dynamics_[b].set_time(time);
    integrators_[b]->advance(dynamics_[b], time_step, motion_.bodies[b]);
    outcome.integration = combined(outcome.integration, motion_.bodies[b].report);
  }
  motion_.rigids.clear();
  for (const Collider& collider : system_->colliders) {
    motion_.rigids.push_back(
        free_motion(collider, system_->gravity, options_.integrator, time_step));
  }
  blow_up_ = find_non_finite_force();
  if (!blow_up_) blow_up_ = find_exhausted();
  if (!blow_up_) blow_up_ = find_blow_up(*system_, motion_);
  if (!blow_up_) {
    const ContactOutcome contact = contact_->resolve(*system_, motion_);
    outcome.contact = combined(outcome.contact, contact);
    outcome.contact.num_contacts = contact.num_contacts;
    if (contact.exhausted) {
      blow_up_ =
          BlowUp{system_->bodies[contact.exhausted->body].name, 0, contact.exhausted->reason};
    }
    const std::int64_t budget = contact_visit_budget(*system_);
    if (!blow_up_ && outcome.contact.search_share > kSearchesOfStep) {
      blow_up_ = BlowUp{system_->bodies[0].name, 0,
                        "the contact search took more distances of pairs in the substeps of a step "
                        "than 20 times its budget"};
    }
    if (!blow_up_ && outcome.contact.visits > budget) {
      blow_up_ = BlowUp{system_->bodies[0].name, 0,
                        over_budget("visited contacts", outcome.contact.visits, "times", budget)};
    }
  }
  write(time_step);
  if (!blow_up_) blow_up_ = find_non_finite_force();
  if (!blow_up_) blow_up_ = find_blow_up(*system_);
}

void SpringSolver::write(double time_step) {
  for (std::size_t b = 0; b < dynamics_.size(); ++b) {
    Body& body = system_->bodies[b];
    body.positions += time_step * motion_.bodies[b].mean_velocities;
    body.velocities = motion_.bodies[b].end_velocities;
    integrators_[b]->finish(dynamics_[b], body.positions, time_step, body.velocities);
  }
  for (std::size_t k = 0; k < system_->colliders.size(); ++k) {
    write_motion(motion_.rigids[k], time_step, system_->colliders[k]);
  }
}

Stability SpringSolver::stability() {
  return assess(*system_, options_.integrator);
}

std::optional<BlowUp> SpringSolver::find_exhausted() const {
  for (std::size_t b = 0; b < motion_.bodies.size(); ++b) {
    const char* reason = motion_.bodies[b].report.exhausted;
    if (reason) return BlowUp{system_->bodies[b].name, 0, reason};
  }
  return std::nullopt;
}

std::optional<BlowUp> SpringSolver::find_non_finite_force() const {
  for (const BodyDynamics& dynamics : dynamics_) {
    if (const auto node = dynamics.first_non_finite_node()) {
      return BlowUp{dynamics.body().name, *node, "state was not finite within the step"};
    }
  }
  return std::nullopt;
}

}  // namespace weft::reference

#include <weft/reference/contact/contact_model.hpp>

#include <algorithm>

#include <weft/core/error.hpp>

namespace weft::reference {

std::unique_ptr<ContactModel> make_contact_model(ContactKind kind) {
  switch (kind) {
    case ContactKind::kProjection:
      return make_projection_contact();
    case ContactKind::kImpulse:
      return make_impulse_contact();
  }
  throw InvalidArgument("reference solver: contact = " + std::to_string(static_cast<int>(kind)) +
                        ", expected a value of ContactKind");
}

ContactOutcome combined(const ContactOutcome& first, const ContactOutcome& second) {
  ContactOutcome sum = first;
  sum.num_contacts = std::max(first.num_contacts, second.num_contacts);
  sum.sweeps += second.sweeps;
  sum.visits += second.visits;
  sum.search_share += second.search_share;
  sum.passes += second.passes;
  sum.converged = first.converged && second.converged;
  sum.num_stopped_nodes += second.num_stopped_nodes;
  if (!sum.exhausted) sum.exhausted = second.exhausted;
  sum.normal_impulse += second.normal_impulse;
  return sum;
}

}  // namespace weft::reference

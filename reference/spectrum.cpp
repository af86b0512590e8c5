#include <weft/reference/spectrum.hpp>

namespace weft::reference {

Spectrum spectrum(Body& body) {
  return forces::spectrum(body.laws, {body.positions, body.velocities, body.mesh.masses},
                          inverse_masses(body.mesh));
}

}  // namespace weft::reference

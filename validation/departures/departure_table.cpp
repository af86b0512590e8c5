// What is known to fail, by cause. Made from a report by tools/state_departures.py; causes are written by hand.
#include <weft/validation/departures/stated_departures.hpp>

namespace weft::validation {

std::span<const StatedDeparture> stated_departures() {
  static const std::vector<StatedDeparture> kTable = {};
  return kTable;
}

}  // namespace weft::validation

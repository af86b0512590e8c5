#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <BulletSoftBody/btSoftBody.h>

/// The stretch of the most stretched link [%]; not finite if a node is not.
inline double longest_stretch(const btSoftBody& body) {
  double most = 0;
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    if (link.m_bbending != 0) continue;
    const double length = static_cast<double>((link.m_n[0]->m_x - link.m_n[1]->m_x).length());
    const double stretch = 100 * (length / static_cast<double>(link.m_rl) - 1);
    if (!(stretch <= most)) most = stretch;
  }
  return most;
}

/// Prints what the program has found. With a limit for the stretch [%] as its argument it ends with 1 where that is exceeded or something
/// is not in its place.
inline int end_with(const char* what, double stretch, bool is_in_place, int argc, char** argv) {
  std::printf("%s%s; the longest link is stretched by %.2f %%\n", what,
              is_in_place ? "" : ", which did not end well", stretch);
  if (argc < 2) return 0;
  return is_in_place && stretch <= std::atof(argv[1]) ? 0 : 1;
}

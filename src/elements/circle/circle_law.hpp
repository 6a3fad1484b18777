#pragma once

// What small disturbances meet in a friction circle that slips, over a period or, of one whose force is odd,
// half of one. With n = e^{i phi} the direction of the force T, t = i n and z = r - T/k the slider's place,
//
//   stick   dT = k (dr - dz),   dz as it was where slip ended, or dr - (r'/n') dn where the parts touched
//   slip    dT = mu k_n dg n + k (t.dr - m) t,   m = t.dz,   n.dz = n.dr - mu k_n/k dg,
//           dm/dtheta = -phi' (n.dr - mu k_n/k dg) + (v/b) (t.dr - m)
//   apart   dT = 0
//
// with v and b of slip_panel.hpp, and of the normal force dN = k_n dg where the parts touch. Force and rate
// of slip are continuous where slip begins and ends, so that ends that move add nothing but at re-contact.

#include "arcslip/elements/disturbed_law.hpp"
#include "elements/circle/circle_course.hpp"

namespace arcslip {

/// Of x and y or, `closes`, of g as well; `turn`: pi or 2 pi.
DisturbedLaw circle_law(const CircleMotion& motion, const CircleCourse& course, bool closes, double turn);

}  // namespace arcslip

#pragma once

// The study of a preload for any response that is traced over eta and has the preload P as a parameter: any
// number of contacts and harmonics, with or without cubic springs.

#include "arcslip/problems/ridges/highest_peak.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip::problems {

/// What a study says of a system beyond its response.
struct StudiedContacts {
  std::vector<SectorContact> contacts;  ///< of one node or sector
  double nodes = 1;                     ///< N
  double preload_growth = 0;            ///< P_2 of the preload P + P_2 eta^2
  bool is_homogeneous = true;           ///< whether Y is proportional to force and preload together
  bool is_by_load = true;  ///< whether friction coefficients count as factors on the preload alone
  std::vector<std::string> others = {};  ///< names of the elements beside these that rub
};

/// How well a study knows what lies between the preloads at which it solves the response.
struct StudyPrecision {
  double envelope = 0;  ///< of ln Y_max by cubics between them; 0: as well as the optimum asks for
  double range = 1e-6;  ///< of the preloads between which Y_max stays within a factor 2, relative
  HighestPeak::Looks looks = HighestPeak::Looks::whole;  ///< how it looks at the responses
};

/// The peaks of the response, over eta, as P varies over the range. Of PreloadStudy `free_eta`, `free_Y` and
/// the optimum's `damping` are left to be filled in; sensitivities to mass ratio and frequency ratio are nan.
/// Births and deaths of peaks are known to the distance of preloads, all else is located. What cannot be
/// traced is told by `failure`.
PreloadStudy study_response(ResponsePeaks& responses, const PreloadRange& range,
                            const StudiedContacts& contacts, const StudyPrecision& precision = {});

}  // namespace arcslip::problems

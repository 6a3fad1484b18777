#pragma once

// One design of a study, solved: by closed slopes where it has one contact, one harmonic and no other spring,
// by whole responses else.

#include "arcslip/cases/study_case.hpp"

namespace arcslip {

/// The study of a design. Throws what its parts throw where it cannot be begun; what fails later is told by
/// its `failure`.
problems::PreloadStudy study_preload(const StudyCase& study, const StudyDesign& design);

/// What scatter makes of it, where the study asks for that.
problems::UncertainPeaks study_uncertainty(const StudyCase& study, const StudyDesign& design,
                                           const problems::PreloadStudy& nominal);

/// A design's response at its best preload, solved anew with more harmonics.
struct HarmonicsCheck {
  std::size_t curve = 0;
  double preload = 0;
  std::vector<int> harmonics;  ///< with which
  double eta = 0;              ///< of the highest peak there
  double Y = 0;                ///< its height
  double moved_by = 0;         ///< relative, from the highest peak of the study
  bool same_peak = true;       ///< whether it is one that was the highest there
  std::string failure;         ///< why it could not be solved, or empty
};

/// `harmonics` are those of the study at this preload, about twice as many and 9 at least are taken.
HarmonicsCheck check_harmonics(const StudyCase& study, const StudyDesign& design,
                               const std::vector<int>& harmonics, double preload);

}  // namespace arcslip

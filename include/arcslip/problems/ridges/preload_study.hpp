#pragma once

// The highest peak of the base's amplitude over a window of eta, as the preload varies, and the preload at
// which it is lowest:
//
//   Y_max(P) = max over eta of Y(eta, P),   P_opt = argmin Y_max(P)
//
// Peaks are found on complete frequency responses and followed in P as solutions of dY/deta = 0, or of R = S
// where a peak sits on the corner between stick and slip, from their births to their deaths. Everything
// between is located, not sampled: births, deaths, exchanges of the highest peak, corners of the envelope,
// the optimum and its width.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::problems {

/// What is studied: preloads from..to, and the window of eta in which peaks are sought.
struct PreloadRange {
  double from = 0;              ///< > 0
  double to = 0;                ///< > from
  double eta_low = 0;           ///< > 0
  double eta_high = 0;          ///< > eta_low
  std::vector<double> stop_at;  ///< preloads at which every peak gets a point
};

/// Logarithmic sensitivities d ln Y/d ln x of a peak, each with the others (and K_FD, zeta) fixed.
struct PeakSensitivity {
  double preload = 0;          ///< P; at a smooth optimum 0
  double friction = 0;         ///< mu; the same as P but where the preload grows with eta^2
  double force = 0;            ///< F
  double mass_ratio = 0;       ///< M*
  double frequency_ratio = 0;  ///< gamma
};

/// Where a peak sits: in slip or in stick with dY/deta = 0, on the corner R = S, or on an end of the window
/// while Y still rises towards it.
enum class PeakSite { slip, stick, corner, edge };

/// What a point of a peak's branch is.
enum class PeakType {
  regular,
  start,     ///< the first preload of the range
  end,       ///< the last one
  birth,     ///< the peak appears here as P grows
  death,     ///< it vanishes
  corner,    ///< it changes its site
  exchange,  ///< here it becomes the highest, or stops being it
  optimum,   ///< the highest peak is lowest here
  user       ///< a value of `stop_at`
};

/// As written to files: their names.
std::string_view to_string(PeakSite site);
std::string_view to_string(PeakType type);

/// One local peak of Y over eta at one preload.
struct Peak {
  PeakType type = PeakType::regular;  ///< what is special about it
  PeakSite site = PeakSite::slip;     ///< where it sits
  double preload = 0;                 ///< P
  double eta = 0;                     ///< of the peak
  double Y = 0;                       ///< its height
  double R_over_S = 0;                ///< above 1 in slip
  double dissipated = 0;        ///< energy lost to friction per cycle and contact over k S^2, 4 (R/S - 1)
  PeakSensitivity sensitivity;  ///< of Y
  bool is_global = false;       ///< the highest of all at this preload
};

/// One local peak followed in P, P rising from point to point.
using PeakBranch = std::vector<Peak>;

/// What the optimum is.
enum class OptimumKind {
  smooth,    ///< dY_max/dP = 0
  exchange,  ///< two peaks of equal height change places
  corner,    ///< the highest peak changes its site, with a kink of Y_max
  flat,      ///< Y_max is the same over a range of preloads: the middle of it, on the scale of ln P
  end,       ///< Y_max is lowest at an end of the range
  jump       ///< beside it the response has a higher peak, with a part that does not belong to it there
};

/// As written to files: its name.
std::string_view to_string(OptimumKind kind);

/// The preload at which Y_max is lowest.
struct Optimum {
  OptimumKind kind = OptimumKind::smooth;  ///< which of them
  Peak peak;                  ///< the highest there, of two the one that is highest just below P_opt
  std::optional<Peak> other;  ///< of an exchange: the one that takes over
  double low = 0;             ///< Y_max <= 2 Y_opt from here ...
  double high = 0;            ///< ... to here; an end of the range where it holds beyond it
  double energy = 0;   ///< lost to friction per cycle by the whole ring, nondimensional: N 4 k S (R - S)
  double damping = 0;  ///< zeta_B with which the base alone would have this peak; nan if none has
};

/// One design's study.
struct PreloadStudy {
  double free_eta = 0;  ///< where the base without damper has its highest amplitude in the window
  double free_Y = 0;    ///< Y_nd_max
  std::vector<PeakBranch> branches;  ///< all local peaks of the range
  std::optional<Optimum> optimum;    ///< none where the study failed
  std::string failure;               ///< why the study is not whole, or empty
  std::vector<int> harmonics = {};   ///< those that were added as the best preload asked for; else empty
};

/// Studies a linear, passive system (without elements beside the contact, damping > 0); its `preload` is not
/// used. Of `options` the tolerance and the limits of steps count. Throws std::invalid_argument for other
/// systems or an empty range. What cannot be traced is told by `failure`, never passed over.
PreloadStudy study_preload(const SystemParameters& system, const PreloadRange& range,
                           const continuation::TraceOptions& options = {});

}  // namespace arcslip::problems

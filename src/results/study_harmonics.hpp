#pragma once

// How far the best preloads of a study stand with more harmonics than it had.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cases/design_study.hpp"
#include "results/study_store.hpp"

namespace arcslip {

/// The designs' best preloads solved anew, of large studies those of some designs spread over all of them,
/// until `go_on` says no.
std::vector<HarmonicsCheck> check_best_preloads(const StudyCase& study, const StudyStore& store,
                                                const std::function<bool()>& go_on);

/// What they say, for one design or for the worst of several; `count` is that of all designs.
std::vector<std::string> sentences_of(const std::vector<HarmonicsCheck>& checks, std::size_t count);

/// Of those with which the study's harmonics mislead: another peak rules, or the height is off by half.
std::vector<std::string> warnings_of(const std::vector<HarmonicsCheck>& checks);

nlohmann::ordered_json to_json(const std::vector<HarmonicsCheck>& checks);

/// The harmonics of each design for which they were found, by its number.
nlohmann::ordered_json harmonics_of(const StudyCase& study, const StudyStore& store);

}  // namespace arcslip

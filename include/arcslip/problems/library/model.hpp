#pragma once

// How the entries of the library are written.

#include <memory>

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The first `count` values as a vector: those settings that are the problem's parameters come first.
inline Vector parameters_of(const LibraryModel::Values& values, Index count) {
  return Eigen::Map<const Vector>(values.data(), count);
}

/// `build` of a problem that has no sizes.
template <class Problem>
std::unique_ptr<continuation::Problem> build_fixed(const LibraryModel::Values& /*values*/) {
  return std::make_unique<Problem>();
}

/// `guess` of a problem whose settings are its parameters, from a function of these.
template <class Unknowns>
auto guess_at(Unknowns unknowns) {
  return [unknowns](const continuation::Problem& problem, const LibraryModel::Values& values) {
    const auto count = static_cast<Index>(problem.parameter_names().size());
    const Vector parameters = parameters_of(values, count);
    continuation::Guess guess;
    guess.unknowns = unknowns(problem, parameters);
    guess.parameters = parameters;
    return guess;
  };
}

}  // namespace arcslip::problems

#pragma once

// Surfaces over two parameters as tables: atlas.csv, faces.csv, folds.csv and ridges.csv.

#include <nlohmann/json.hpp>
#include <string>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// One row for each chart: branch, chart, component, the parameters, the observables, determinant, unstable
/// where eigenvalues tell it, radius; of a system in SI units more.
std::string atlas_header(const TracedBranch& traced);
std::string atlas_rows(std::size_t number, const TracedBranch& traced);

/// One row for each triangle: branch, face, chart_1, chart_2, chart_3.
std::string faces_header(const TracedBranch& traced);
std::string face_rows(std::size_t number, const TracedBranch& traced);

/// One row for each point of curves of folds: branch, fold_curve, point, type, turns, the parameters, the
/// observables.
std::string folds_header(const TracedBranch& traced);
std::string fold_rows(std::size_t number, const TracedBranch& traced);

/// The same of ridges: branch, ridge, point, type, observable, the parameters, the observables.
std::string ridges_header(const TracedBranch& traced);
std::string ridge_rows(std::size_t number, const TracedBranch& traced);

/// What summary.json says of a surface, and a line of it.
nlohmann::ordered_json surface_to_json(const TracedBranch& traced);
std::string surface_sentence(const nlohmann::ordered_json& told);

}  // namespace arcslip

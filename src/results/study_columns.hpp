#pragma once

// Columns of the tables of a study, as its database and its files have them.

#include <fmt/format.h>

#include <array>
#include <string>

namespace arcslip {

/// Columns of optimum.csv behind those of for_each.
inline constexpr std::array optimum_columns = {"P_opt",
                                               "eta_opt",
                                               "Y_opt",
                                               "ratio_opt",
                                               "kind",
                                               "P_low",
                                               "P_high",
                                               "Y_nd_max",
                                               "R_over_S",
                                               "dissipated",
                                               "energy",
                                               "zeta_eq",
                                               "site",
                                               "by_P",
                                               "by_mu",
                                               "by_F",
                                               "by_mass_ratio",
                                               "by_frequency_ratio",
                                               "eta_other",
                                               "by_P_other",
                                               "by_mu_other",
                                               "by_F_other",
                                               "by_mass_ratio_other",
                                               "by_frequency_ratio_other"};

/// A name in SQL, where a key of for_each may have a dot.
inline std::string sql_name(const std::string& name) { return fmt::format("\"{}\"", name); }

/// The equal rings among designs that have patterns.
inline std::string of_equal_rings(std::size_t each) { return fmt::format(" WHERE d.curve % {} = 0", each); }

}  // namespace arcslip

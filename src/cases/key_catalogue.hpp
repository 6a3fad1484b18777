#pragma once

// All keys of case files, for whoever wants to know what there is.

#include "keys/key_table.hpp"

namespace arcslip {

/// A section with its keys, those of tables in it by dotted names.
struct KeySection {
  std::string name;  ///< "branch"; "" of the top of the file
  std::string note;  ///< which of several sections of this name it is
  std::vector<KeyWords> keys;
  bool repeats = false;  ///< whether there may be several such tables

  std::string heading() const { return repeats ? "[[" + name + "]]" : "[" + name + "]"; }
};

std::vector<KeySection> key_catalogue();

}  // namespace arcslip

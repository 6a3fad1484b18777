#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

LibraryModel::Values defaults(const LibraryModel& model) {
  LibraryModel::Values values;
  for (const Setting& setting : model.settings) values.push_back(setting.value);
  return values;
}

}  // namespace arcslip::problems

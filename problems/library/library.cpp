#include "arcslip/problems/library/library.hpp"

#include <algorithm>

#include "arcslip/problems/library/ab.hpp"
#include "arcslip/problems/library/bratu.hpp"
#include "arcslip/problems/library/bratu_2d.hpp"
#include "arcslip/problems/library/cusp.hpp"
#include "arcslip/problems/library/duffing.hpp"
#include "arcslip/problems/library/enz.hpp"
#include "arcslip/problems/library/freudenstein_roth.hpp"
#include "arcslip/problems/library/lorenz84.hpp"
#include "arcslip/problems/library/lure.hpp"
#include "arcslip/problems/library/pp2.hpp"

namespace arcslip::problems {

const std::vector<LibraryModel>& library() {
  static const std::vector<LibraryModel> models{
      ab_model(),      bratu_model(), bratu_2d_model(),          cusp_model(),
      duffing_model(), enz_model(),   freudenstein_roth_model(), lorenz84_model(),
      lure_model(),    pp2_model()};
  return models;
}

LibraryModel::Values defaults(const LibraryModel& model) {
  LibraryModel::Values values;
  for (const Setting& setting : model.settings) values.push_back(setting.value);
  return values;
}

const LibraryModel* find_model(const std::string& name) {
  const auto& models = library();
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const LibraryModel& model) { return model.name == name; });
  return found == models.end() ? nullptr : &*found;
}

}  // namespace arcslip::problems

#include "cases/uncertain_section.hpp"

#include <algorithm>
#include <functional>
#include <tuple>

namespace arcslip {
namespace {

using problems::Scatter;
using problems::Uncertainty;

void read_uniform(Scatter& scatter, const TomlSection& section) {
  scatter.kind = Scatter::Kind::uniform;
  std::tie(scatter.low, scatter.high) =
      section.rising("uniform", "two factors of the nominal value, 0 < low < high");
}

const KeyTable<Scatter>& scatter_keys() {
  using K = Key<Scatter>;
  const auto is_lognormal = [](Scatter& scatter, const TomlSection&) {
    scatter.kind = Scatter::Kind::lognormal;
  };
  static const KeyTable<Scatter> keys{
      {K("lognormal", &Scatter::deviation, up_to(1), "standard deviation of the logarithm, whose median is 0",
         then(is_lognormal), unresolved),
       K::special("uniform", "two numbers", "range, in place of lognormal", read_uniform)}};
  return keys;
}

template <class... Term>
Key<Uncertainty> factor(const std::string& name, Scatter Uncertainty::*member, const Term&... term) {
  const auto check = [=](const Uncertainty&, const TomlSection& section) {
    const TomlSection given = section.inside(name, "a table");
    if (given.has("lognormal") == given.has("uniform"))
      section.fail(name, "expected { lognormal = ... } or { uniform = [...] }");
  };
  return Key<Uncertainty>::table(name, member, scatter_keys(), "at least one of mu, preload and force",
                                 "a table", "distribution of the factor on its nominal value", unresolved,
                                 then(check), otherwise("1"), term...);
}

void check_quantiles(const Uncertainty& uncertainty, const TomlSection& section) {
  const std::vector<double>& q = uncertainty.quantiles;
  if (q.empty() || std::adjacent_find(q.begin(), q.end(), std::greater_equal<>()) != q.end())
    section.mismatch("quantiles", "an array of rising numbers > 0 and < 1");
}

}  // namespace

const KeyTable<Uncertainty>& uncertain_keys() {
  using S = Uncertainty;
  using K = Key<S>;
  static const KeyTable<S> keys{
      {factor("mu", &S::friction, needed("1; one of the three is needed", lacks("preload", "force"))),
       factor("preload", &S::preload), factor("force", &S::force),
       K("samples", &S::samples, within(100, 1e6, " >= 100 and <= 1e6"), "of a Latin hypercube"),
       K("seed", &S::seed, at_least(0), "the same one gives the same samples everywhere"),
       K("quantiles", &S::quantiles, inside(0, 1), "of the highest peak, at every preload",
         then(check_quantiles))}};
  return keys;
}

}  // namespace arcslip

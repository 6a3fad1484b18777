#include "python/binding/own_element.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "arcslip/elements/hysteretic.hpp"
#include "arcslip/elements/sampled.hpp"
#include "python/binding/arrays.hpp"

namespace arcslip::python {

namespace {

/// The functions of an element with values of its settings, one of which may be continued.
class Functions {
 public:
  Functions(std::shared_ptr<const py::object> element, std::shared_ptr<Raised> raised,
            const std::vector<Jet>& settings)
      : element_(std::move(element)), raised_(std::move(raised)), values_(std::ssize(settings)) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      values_(static_cast<Index>(i)) = settings[i].value;
      if (settings[i].first == 0) continue;
      varied_ = static_cast<int>(i);
      rate_ = settings[i];
    }
  }

  int varied() const { return varied_; }
  const Jet& rate() const { return rate_; }
  const Vector& values() const { return values_; }
  /// Of its attributes, with the lock held.
  py::object attribute(const char* name) const { return element_->attr(name); }

  /// See Raised::watch.
  template <class Work>
  void call(const Work& work) const {
    raised_->watch(work);
  }

 private:
  std::shared_ptr<const py::object> element_;
  std::shared_ptr<Raised> raised_;
  Vector values_;
  int varied_ = -1;
  Jet rate_;
};

/// Of the momentary displacement.
class PythonLaw final : public SampledLaw {
 public:
  explicit PythonLaw(Functions functions) : functions_(std::move(functions)) {}

  void at(const Vector& x, int derivatives, LawSamples& out) const override {
    functions_.call([&] { fill(x, derivatives, out); });
  }

 private:
  void fill(const Vector& x, int derivatives, LawSamples& out) const {
    const Jet& rate = functions_.rate();
    const auto given = py::cast<py::list>(functions_.attribute("_sampled")(give(x), give(functions_.values()),
                                                                           functions_.varied(), derivatives));
    auto next = [&, at = std::size_t{0}](Vector& values) mutable {
      values.resize(x.size());
      take(given[at++], "force", values);
    };
    out = {};
    next(out.force);
    if (derivatives == 0) return;
    next(out.slope);
    if (derivatives > 1) next(out.curvature);
    if (functions_.varied() < 0) return;
    next(out.by_setting);
    if (derivatives > 1) {
      next(out.slope_by_setting);
      next(out.second_by_setting);
      out.second_by_setting =
          out.second_by_setting * (rate.first * rate.first) + out.by_setting * rate.second;
      out.slope_by_setting *= rate.first;
    }
    out.by_setting *= rate.first;
  }

  Functions functions_;
};

/// Of the displacement over a period.
class PythonCycle final : public CycleLaw {
 public:
  /// With the lock held.
  explicit PythonCycle(Functions functions)
      : functions_(std::move(functions)), samples_(functions_.attribute("samples").cast<Index>()) {
    if (!functions_.attribute("sticks").is_none()) functions_.call([&] { stuck_ = ask_stuck(); });
  }

  std::optional<StuckRange> stuck() const override { return stuck_; }

  Index samples() const override { return samples_; }

  double setting_scale() const override {
    constexpr double least = 1e-8;
    if (functions_.varied() < 0) return 1;
    const double value = std::abs(functions_.values()(functions_.varied()));
    return std::max(value, least) / std::abs(functions_.rate().first);
  }

  void at(const Vector& x, const Matrix& ways, double setting, bool derivatives,
          CycleSamples& out) const override {
    functions_.call([&] { fill(x, ways, setting, derivatives, out); });
  }

 private:
  void fill(const Vector& x, const Matrix& ways, double setting, bool derivatives, CycleSamples& out) const {
    const int varied = functions_.varied();
    const Jet& rate = functions_.rate();
    Vector values = functions_.values();
    if (varied >= 0) values(varied) += setting * (rate.first + setting * rate.second / 2);
    const auto given = py::cast<py::list>(
        functions_.attribute("_cycle")(give(x), give(ways), give(values), varied, derivatives));
    out = {};
    out.force.resize(x.size());
    take(given[0], "force", out.force);
    if (!derivatives) return;
    out.changes.resize(x.size(), ways.cols());
    take(given[1], "slope", out.changes);
    if (varied < 0) return;
    out.by_setting.resize(x.size());
    take(given[2], "force", out.by_setting);
    out.by_setting *= rate.first + setting * rate.second;
  }

  StuckRange ask_stuck() const {
    const auto given =
        py::cast<py::list>(functions_.attribute("_stuck")(give(functions_.values()), functions_.varied()));
    const Jet& rate = functions_.rate();
    const auto jet = [&](std::size_t i) {  // by what is continued, of which the setting is a function
      const auto by = [&](std::size_t order) { return given[3 * i + order].cast<double>(); };
      return Jet(by(0), by(1) * rate.first, by(2) * rate.first * rate.first + by(1) * rate.second);
    };
    return {jet(0), jet(1)};
  }

  Functions functions_;
  Index samples_;
  std::optional<StuckRange> stuck_;
};

std::shared_ptr<const Element> made(Functions functions, bool has_memory, double usual_stiffness) {
  if (!has_memory)
    return std::make_shared<SampledElement>(std::make_shared<PythonLaw>(std::move(functions)),
                                            usual_stiffness);
  const py::gil_scoped_acquire lock;
  return std::make_shared<HystereticElement>(std::make_shared<PythonCycle>(std::move(functions)),
                                             usual_stiffness);
}

}  // namespace

std::shared_ptr<const ElementKind> kind_of(const py::object& element, const std::shared_ptr<Raised>& raised) {
  auto kind = std::make_shared<ElementKind>();
  kind->name = element.attr("kind").cast<std::string>();
  kind->meaning = "of one's own";
  if (find_element_kind(kind->name) != nullptr)
    throw py::value_error(fmt::format("element '{}': there is a kind of this name", kind->name));
  for (const py::handle item : element.attr("_settings")) {
    const auto setting = py::cast<py::tuple>(item);
    const double given =
        setting[1].is_none() ? std::numeric_limits<double>::quiet_NaN() : setting[1].cast<double>();
    kind->settings.push_back(
        {any_value(setting[0].cast<std::string>(), given, "of one's own"), setting[2].cast<bool>()});
  }
  kind->takes_any_orders = false;
  kind->has_memory = element.attr("memory").cast<bool>();
  kind->make = [element = kept(element), raised,
                has_memory = kind->has_memory](const ElementKind::Values& values) {
    return made({element, raised, values.settings}, has_memory, values.usual_stiffness);
  };
  return kind;
}

}  // namespace arcslip::python

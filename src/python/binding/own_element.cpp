#include "python/binding/own_element.hpp"

#include <fmt/format.h>

#include <limits>

#include "arcslip/elements/sampled.hpp"
#include "python/binding/arrays.hpp"

namespace arcslip::python {

void Raised::note(std::exception_ptr error) {
  const std::scoped_lock lock(mutex_);
  if (!error_) error_ = std::move(error);
  any_ = true;
}

void Raised::rethrow() {
  std::exception_ptr error;
  {
    const std::scoped_lock lock(mutex_);
    error = std::exchange(error_, nullptr);
    any_ = false;
  }
  if (error) std::rethrow_exception(error);
}

namespace {

/// What may be dropped by threads without the interpreter's lock.
std::shared_ptr<const py::object> kept(const py::object& object) {
  return {new py::object(object), [](const py::object* last) {
            const py::gil_scoped_acquire lock;
            delete last;
          }};
}

/// The law with values of its settings, one of which may be continued.
class PythonLaw final : public SampledLaw {
 public:
  PythonLaw(std::shared_ptr<const py::object> element, std::shared_ptr<Raised> raised,
            std::vector<Jet> settings)
      : element_(std::move(element)), raised_(std::move(raised)), values_(std::ssize(settings)) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      values_(static_cast<Index>(i)) = settings[i].value;
      if (settings[i].first == 0) continue;
      varied_ = static_cast<int>(i);
      rate_ = settings[i];
    }
  }

  void at(const Vector& x, int derivatives, LawSamples& out) const override {
    const py::gil_scoped_acquire lock;
    try {
      try {
        fill(x, derivatives, out);
      } catch (py::error_already_set& error) {
        if (!error.matches(PyExc_KeyboardInterrupt)) throw;
        raised_->interrupted = true;  // the work ends at its next point
        fill(x, derivatives, out);
      }
    } catch (...) {
      raised_->note(std::current_exception());
      throw;
    }
  }

 private:
  void fill(const Vector& x, int derivatives, LawSamples& out) const {
    const auto given =
        py::cast<py::list>(element_->attr("_sampled")(give(x), give(values_), varied_, derivatives));
    auto next = [&, at = std::size_t{0}](Vector& values) mutable {
      values.resize(x.size());
      take(given[at++], "force", values);
    };
    out = {};
    next(out.force);
    if (derivatives == 0) return;
    next(out.slope);
    if (derivatives > 1) next(out.curvature);
    if (varied_ < 0) return;
    next(out.by_setting);
    if (derivatives > 1) {
      next(out.slope_by_setting);
      next(out.second_by_setting);
      out.second_by_setting =
          out.second_by_setting * (rate_.first * rate_.first) + out.by_setting * rate_.second;
      out.slope_by_setting *= rate_.first;
    }
    out.by_setting *= rate_.first;
  }

  std::shared_ptr<const py::object> element_;
  std::shared_ptr<Raised> raised_;
  Vector values_;
  int varied_ = -1;
  Jet rate_;
};

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
  kind->make = [element = kept(element), raised](const ElementKind::Values& values) {
    return std::make_shared<SampledElement>(std::make_shared<PythonLaw>(element, raised, values.settings),
                                            values.usual_stiffness);
  };
  return kind;
}

}  // namespace arcslip::python

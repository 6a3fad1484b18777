#include "python/binding/own_structure.hpp"

#include <mutex>

#include "arcslip/assembly/given_structures.hpp"
#include "python/binding/arrays.hpp"

namespace arcslip::python {
namespace {

ContactVector vector_of(const py::handle& given, Index count, const char* what) {
  ComplexVector values(count);
  take(given, what, values);
  return values;
}

/// Of rows one after another.
ContactMatrix matrix_of(const py::handle& given, Index count, const char* what) {
  ComplexVector values(count * count);
  take(given, what, values);
  return Eigen::Map<const ComplexMatrix>(values.data(), count, count).transpose();
}

/// One of the two with what it answered last: much of the work stays at one eta.
class PythonPart {
 public:
  PythonPart(std::shared_ptr<const py::object> structure, std::shared_ptr<Raised> raised, Index contacts,
             const char* name)
      : structure_(std::move(structure)), raised_(std::move(raised)), contacts_(contacts), name_(name) {}

  ContactReceptance at(Index wave, double eta) {
    {
      const std::scoped_lock lock(mutex_);
      if (wave == wave_ && eta == eta_) return last_;
    }
    ContactReceptance response;
    raised_->watch([&] { ask(wave, eta, response); });
    const std::scoped_lock lock(mutex_);
    wave_ = wave;
    eta_ = eta;
    last_ = response;
    return response;
  }

  std::vector<ContactMode> modes(Index wave) const {
    std::vector<ContactMode> all;
    raised_->watch([&] {
      all.clear();
      for (const py::handle one : structure_->attr("_modes")(name_, wave)) {
        const auto mode = py::cast<py::tuple>(one);
        all.push_back({mode[0].cast<double>(), vector_of(mode[1], contacts_, "shape"), 0});
      }
    });
    return all;
  }

 private:
  void ask(Index wave, double eta, ContactReceptance& response) const {
    const auto given = py::cast<py::tuple>(structure_->attr("_respond")(name_, eta, wave));
    response.compliance = matrix_of(given[0], contacts_, "compliance");
    response.free = vector_of(given[1], contacts_, "free response");
    response.compliance_eta = matrix_of(given[2], contacts_, "compliance");
    response.free_eta = vector_of(given[3], contacts_, "free response");
  }

  std::shared_ptr<const py::object> structure_;
  std::shared_ptr<Raised> raised_;
  Index contacts_;
  const char* name_;
  std::mutex mutex_;
  Index wave_ = -1;
  double eta_ = 0;
  ContactReceptance last_;
};

}  // namespace

std::shared_ptr<const Structures> structures_of(const py::object& structure,
                                                const std::shared_ptr<Raised>& raised) {
  const auto contacts = structure.attr("contacts").cast<Index>();
  const std::shared_ptr<const py::object> object = kept(structure);
  const auto part = [&](const char* name) {
    const auto asked = std::make_shared<PythonPart>(object, raised, contacts, name);
    return GivenPart{[asked](Index wave, double eta) { return asked->at(wave, eta); },
                     [asked](Index wave) { return asked->modes(wave); }};
  };
  std::optional<GivenPart> damper;
  if (!structure.attr("damper").is_none()) damper = part("damper");
  return std::make_shared<const GivenStructures>(contacts, part("base"), std::move(damper));
}

}  // namespace arcslip::python

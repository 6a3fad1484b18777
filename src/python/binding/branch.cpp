#include "python/binding/branch.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <sstream>

#include "arcslip/continuation/path/interpolation.hpp"
#include "arcslip/continuation/path/polyline.hpp"
#include "cases/cycles.hpp"
#include "results/branch_columns.hpp"
#include "results/run_progress.hpp"

namespace arcslip::python {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using Detail = BranchTable::Detail;

template <class Part>
Matrix gathered(const Branch& branch, Part part) {
  const std::vector<BranchPoint>& points = branch.points;
  Matrix all(points.empty() ? 0 : part(points.front()).size(), std::ssize(points));
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Index>(i)) = part(points[i]);
  return all;
}

/// Samples as points of which columns can be told.
BranchPoint as_point(const continuation::Sample& sample) {
  BranchPoint point;
  point.regime = sample.regime;
  point.unknowns = sample.unknowns;
  point.parameters = sample.parameters;
  point.arclength = sample.arclength;
  point.residual = std::nan("");
  return point;
}

py::dict columns_of(Table table) {
  py::dict columns;
  const py::object rows = give(std::move(table.values));
  for (std::size_t k = 0; k < table.names.size(); ++k) columns[table.names[k].c_str()] = rows[py::int_(k)];
  return columns;
}

py::dict sampled(const BranchHandle& handle, const std::vector<continuation::Sample>& samples) {
  const continuation::Problem& problem = handle.traced().problem();
  std::vector<BranchPoint> points;
  Matrix error(problem.size() + 1, std::ssize(samples));
  Matrix unknowns(problem.size(), std::ssize(samples));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    points.push_back(as_point(samples[i]));
    unknowns.col(static_cast<Index>(i)) = samples[i].unknowns;
    error.col(static_cast<Index>(i)) = samples[i].error;
  }
  Table table = handle.tabulate(points, Detail::full);
  py::dict all;
  all["columns"] = columns_of(std::move(table));
  all["unknowns"] = give(std::move(unknowns));
  all["error"] = give(std::move(error));
  return all;
}

template <class Samples>
py::dict sampled_by(const BranchHandle& handle, const Samples& samples) {
  if (orbits_of(handle.traced()) != nullptr)
    throw py::value_error(
        "samples of cycles and other orbits are not taken: their unknowns lie on meshes of their own; see "
        "orbit");
  if (handle.branch().points.size() < 2)
    throw py::value_error("a branch of fewer than two points has nothing between them");
  return handle.heard([&] {
    return sampled(handle, samples(continuation::InterpolatedBranch(handle.branch(), handle.parameter(),
                                                                    &handle.traced().problem())));
  });
}

py::dict drawn(const BranchHandle& handle) {
  return handle.heard([&] {
    Columns columns(handle.traced(), Detail::drawn);
    const auto drawn = continuation::polyline(
        handle.branch(), handle.parameter(),
        [&](const BranchPoint& point) -> const std::vector<double>& { return columns.values(point); },
        &handle.traced().problem());
    return columns_of(handle.tabulate(drawn.points, Detail::drawn));
  });
}

std::string text_of(const continuation::Checkpoint& checkpoint) {
  std::ostringstream out;
  write(out, checkpoint);
  return out.str();
}

py::list kinds(const BranchHandle& handle) {
  py::list all;
  for (const BranchPoint& point : handle.branch().points) all.append(py::str(to_string(point.type).data()));
  return all;
}

py::list regimes(const BranchHandle& handle) {
  py::list all;
  for (const BranchPoint& point : handle.branch().points)
    all.append(handle.traced().base.problem->describe(point.regime));
  return all;
}

py::list labels(const BranchHandle& handle) {
  py::list all;
  for (const BranchPoint& point : handle.branch().points) all.append(point.label);
  return all;
}

py::list eigenvalues(const BranchHandle& handle) {
  py::list all;
  for (const BranchPoint& point : handle.branch().points) all.append(give(point.eigenvalues));
  return all;
}

py::dict work_of(const BranchHandle& handle) {
  const continuation::Work& work = handle.branch().work;
  py::dict all;
  all["evaluations"] = work.evaluations;
  all["factorizations"] = work.factorizations;
  all["iterations"] = work.iterations;
  all["rejected_steps"] = work.rejected_steps;
  return all;
}

}  // namespace

BranchHandle::BranchHandle(TracedBranch traced, std::shared_ptr<PythonProblem> problem)
    : traced_(std::move(traced)), problem_(std::move(problem)) {
  if (!traced_.curve) return;
  // It was made to be traced, and is const only for those who read what was.
  curve_ = std::const_pointer_cast<continuation::ExtendedProblem>(traced_.curve);
  curve_used_ = std::make_shared<std::atomic<bool>>(false);
}

BranchHandle::BranchHandle(TracedBranch traced, const BranchHandle& beside)
    : BranchHandle(std::move(traced), beside.problem_) {
  curve_used_ = beside.curve_used_;
}

CurveUse::CurveUse(std::atomic<bool>* flag) : flag_(flag) {
  if (flag_ != nullptr && flag_->exchange(true))
    throw std::runtime_error("another thread is at work with this curve in two parameters");
}

CurveUse::~CurveUse() {
  if (flag_ != nullptr) *flag_ = false;
}

BranchHandle settled(TracedBranch traced) {
  auto request = std::make_shared<CaseBranch>(*traced.request);
  request->options.go_on = {};
  request->options.journal = nullptr;
  traced.request = request;
  return {std::move(traced), nullptr};
}

Index BranchHandle::parameter() const {
  return continuation::index_of(traced_.problem().parameter_names(), traced_.request->options.parameter);
}

const BranchPoint& BranchHandle::point(std::size_t i) const {
  if (i >= branch().points.size())
    throw py::index_error(fmt::format("point {} of a branch of {}", i, branch().points.size()));
  return branch().points[i];
}

Table BranchHandle::tabulate(const std::vector<BranchPoint>& points, Detail detail) const {
  Columns columns(traced_, detail);
  const PhysicalColumns physical(traced_);
  Table table{columns.names(), {}};
  for (const char* name : {"unstable", "arclength", "iterations", "residual"}) table.names.emplace_back(name);
  table.names.insert(table.names.end(), physical.names().begin(), physical.names().end());
  table.values.resize(std::ssize(points), std::ssize(table.names));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BranchPoint& point = points[i];
    std::vector<double> row = columns.values(point);
    const std::vector<double> in_units = physical.values(row);
    row.insert(row.end(), {static_cast<double>(point.unstable), point.arclength,
                           static_cast<double>(point.iterations), point.residual});
    row.insert(row.end(), in_units.begin(), in_units.end());
    table.values.row(static_cast<Index>(i)) =
        Eigen::Map<const Vector>(row.data(), std::ssize(row)).transpose();
  }
  return table;
}

const Table& BranchHandle::table() {
  if (!table_) {
    table_ = std::make_shared<const Table>(heard([&] { return tabulate(branch().points, Detail::full); }));
    traced_.told = std::shared_ptr<const Matrix>(table_, &table_->values);
  }
  return *table_;
}

const Matrix& BranchHandle::unknowns() {
  if (!unknowns_)
    unknowns_ = gathered(
        branch(), [](const BranchPoint& p) -> auto& { return p.unknowns; });
  return *unknowns_;
}

const Matrix& BranchHandle::tangents() {
  if (!tangents_)
    tangents_ = gathered(
        branch(), [](const BranchPoint& p) -> auto& { return p.tangent; });
  return *tangents_;
}

const Matrix& BranchHandle::parameters() {
  if (!parameters_)
    parameters_ = gathered(
        branch(), [](const BranchPoint& p) -> auto& { return p.parameters; });
  return *parameters_;
}

void bind_branch(py::module_& module) {
  module.def("is_end", [](const std::string& stop) {
    const auto named = continuation::stop_named(stop);
    return named && is_end(*named);
  });
  const auto lent = [](const Matrix& (BranchHandle::*part)()) {
    return [part](const py::object& self) { return lend((self.cast<BranchHandle&>().*part)(), self); };
  };
  py::class_<BranchHandle, std::shared_ptr<BranchHandle>>(module, "Branch")
      .def("__len__", [](const BranchHandle& self) { return self.branch().points.size(); })
      .def("names", [](BranchHandle& self) { return self.table().names; })
      .def("column",
           [](const py::object& self, Index which) {
             return lend_column(self.cast<BranchHandle&>().table().values, which, self);
           })
      .def("unknowns", lent(&BranchHandle::unknowns))
      .def("tangents", lent(&BranchHandle::tangents))
      .def("parameters", lent(&BranchHandle::parameters))
      .def("point_unknowns",
           [](const py::object& self, std::size_t i) {
             return lend(self.cast<const BranchHandle&>().point(i).unknowns, self);
           })
      .def("types", kinds)
      .def("regimes", regimes)
      .def("labels", labels)
      .def("eigenvalues", eigenvalues)
      .def("work", work_of)
      .def("sample",
           [](const BranchHandle& self, std::size_t count) {
             if (count < 2) throw py::value_error("n: expected at least 2");
             return sampled_by(self, [&](const auto& curve) { return curve.resample(count); });
           })
      .def("where",
           [](const BranchHandle& self, double value) {
             return sampled_by(self, [&](const auto& curve) { return curve.where(value); });
           })
      .def("drawn", drawn)
      .def("summary",
           [](const BranchHandle& self, std::size_t number) {
             return self.heard([&] { return summarize(number, self.traced()).dump(); });
           })
      .def("parameter_names",
           [](const BranchHandle& self) { return self.traced().problem().parameter_names(); })
      .def_property_readonly(
          "parameter", [](const BranchHandle& self) { return self.traced().request->options.parameter; })
      .def_property_readonly("values",
                             [](const BranchHandle& self) { return self.traced().request->values.dump(); })
      .def_property_readonly(
          "stop", [](const BranchHandle& self) { return std::string(to_string(self.branch().stop)); })
      .def_property_readonly("explanation",
                             [](const BranchHandle& self) { return self.branch().explanation; })
      .def_property_readonly("warning", [](const BranchHandle& self) { return self.branch().warning; })
      .def_property_readonly("why_not_whole",
                             [](const BranchHandle& self) { return why_not_whole(self.branch()); })
      .def_property_readonly("seconds", [](const BranchHandle& self) { return self.traced().seconds; })
      .def_property_readonly("checkpoint", [](const BranchHandle& self) {
        const auto& checkpoint = self.branch().checkpoint;
        return checkpoint ? std::optional(text_of(*checkpoint)) : std::nullopt;
      });
}

}  // namespace arcslip::python

#include <numeric>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;
using problems::HarmonicResponse;

namespace {

/// The modes of one contact as those of `contacts` ones, with their shape at each of `at`.
ContactModes spread(const ModalModel& model, Index contacts, const std::vector<Index>& at) {
  std::vector<ContactMode> modes;
  for (const Mode& mode : model.modes()) {
    const double shape = std::sqrt(mode.residue);
    ContactMode one{mode.frequency, ContactVector::Zero(contacts), mode.load_residue / shape};
    for (const Index i : at) one.shape(i) = shape;
    modes.push_back(one);
  }
  return {contacts, modes, model.loss()};
}

/// Two structures side by side, each with its own load, under one loss.
ContactModes side_by_side(const ContactModes& first, const ContactModes& second, const Loss& loss) {
  std::vector<ContactMode> modes = first.modes();
  modes.insert(modes.end(), second.modes().begin(), second.modes().end());
  return {first.contacts(), modes, loss};
}

SectorContact contact_of(const FrictionSystem& system) {
  return {system.contact_stiffness, system.slip_per_preload};
}

HarmonicResponse one_contact(const FrictionSystem& system) {
  return HarmonicResponse(
      one_harmonic({spread(system.base, 1, {0}), spread(system.damper, 1, {0}), {contact_of(system)}}));
}

/// The contact of `system` as two, at one place: `share` of the stiffness with the threshold `low` times that
/// of the whole, the rest with `high` times.
HarmonicResponse halved(const FrictionSystem& system, double share, double low, double high) {
  const SectorContact whole = contact_of(system);
  return HarmonicResponse(one_harmonic({spread(system.base, 2, {0, 1}),
                                        spread(system.damper, 2, {0, 1}),
                                        {{share * whole.stiffness, low * whole.slip_per_preload},
                                         {(1 - share) * whole.stiffness, high * whole.slip_per_preload}}}));
}

}  // namespace

TEST_CASE("One contact in Cartesian unknowns has the peaks, troughs and switches of the scalar equation",
          "[contacts]") {
  for (const double preload : {0.1, 1.0, 10.0, 50.0}) {
    const FrictionSystem system = build_system(figure_8(preload));
    const ForcedResponse scalar(system);
    const HarmonicResponse problem = one_contact(system);
    const Branch expected = trace_over_eta(scalar, preload, 0.5, 120);
    const Branch found = trace_over_eta(problem, preload, 0.5, 120);
    CAPTURE(preload, found.explanation);
    REQUIRE(found.complete());
    for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
      const std::vector<BranchPoint> right = of_type(expected, type);
      const std::vector<BranchPoint> points = of_type(found, type);
      REQUIRE(points.size() == right.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK_THAT(points[i].parameters(0), WithinRel(right[i].parameters(0), 1e-10));
        for (Index which = 0; which < 5; ++which)  // to what the digits of eta leave of a sharp peak
          CHECK_THAT(values_at(problem, points[i])(which),
                     WithinRel(values_at(scalar, right[i])(which), 1e-7));
      }
    }
  }
}

TEST_CASE("At the same place and preload all observables of one contact are those of the scalar equation",
          "[contacts]") {
  RandomSystems draw(5);
  for (int i = 0; i < 40; ++i) {
    const SystemParameters parameters = draw.system();
    const FrictionSystem system = build_system(parameters);
    const auto [low, high] = resonance_range(parameters);
    const double eta = draw.log_uniform(low, high);
    const ForcedResponse scalar(system);
    const HarmonicResponse problem = one_contact(system);
    const continuation::Guess right = scalar.guess(eta, parameters.preload);
    const continuation::Guess guess = problem.guess(eta, parameters.preload);
    REQUIRE(guess.regime == right.regime);
    Vector expected;
    Vector values;
    scalar.observe(right.unknowns, right.parameters, right.regime, expected);
    problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
    CAPTURE(i, eta, parameters.preload);
    for (Index k = 0; k < expected.size(); ++k) {
      CAPTURE(k);
      CHECK_THAT(values(k), WithinRel(expected(k), 1e-8) || WithinAbs(expected(k), 1e-9));
    }
  }
}

TEST_CASE(
    "A contact cut into two halves at one place slips in both at once and leaves the response unchanged",
    "[contacts]") {
  for (const double preload : {1.0, 10.0, 50.0}) {
    const FrictionSystem system = build_system(figure_8(preload));
    const HarmonicResponse problem = halved(system, 0.5, 1, 1);
    const Branch expected = trace_over_eta(ForcedResponse(system), preload, 0.5, 120);
    const Branch found = trace_over_eta(problem, preload, 0.5, 120);
    CAPTURE(preload, found.explanation);
    REQUIRE(found.complete());
    const std::vector<BranchPoint> right = of_type(expected, PointType::peak);
    const std::vector<BranchPoint> points = of_type(found, PointType::peak);
    REQUIRE(points.size() == right.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      CHECK_THAT(points[i].parameters(0), WithinRel(right[i].parameters(0), 1e-9));
  }
}

TEST_CASE("Two sliders in parallel slip one after the other, as the sum of their forces says", "[contacts]") {
  const double preload = 3;
  const FrictionSystem system = build_system(figure_8(preload));
  const HarmonicResponse problem = halved(system, 0.3, 0.5, 2);
  const Branch branch = trace_over_eta(problem, preload, 0.5, 6);
  CAPTURE(branch.explanation);
  REQUIRE(branch.complete());
  std::vector<std::string> seen;
  for (const BranchPoint& point : branch.points) {
    const double eta = point.parameters(0);
    const double R = values_at(problem, point)(HarmonicResponse::R);
    const double S = system.slip_threshold(eta, preload);
    const Complex phi =
        0.3 * hysteresis_coefficient(R, 0.5 * S).phi + 0.7 * hysteresis_coefficient(R, 2 * S).phi;
    const ContactResponse base = system.base.at(eta);
    const Complex c = base.compliance + system.damper.at(eta).compliance;
    const double closed = R * std::abs(1.0 + system.contact_stiffness * phi * c);
    CAPTURE(eta, R / S, point.regime);
    // at one place two springs a million times as stiff as the structure share their load to 1e-9 only
    CHECK_THAT(closed, WithinRel(std::abs(base.free), 1e-8));
    seen.push_back(problem.describe(point.regime));
  }
  for (const char* regime : {"stick", "slip 1", "slip"})
    CHECK(std::count(seen.begin(), seen.end(), regime) > 0);
  CHECK(std::count(seen.begin(), seen.end(), "slip 2") == 0);  // the stronger slider never slips alone
}

TEST_CASE("A contact cut into thirty equal ones, which slip at once, is the same", "[contacts][numbers]") {
  constexpr Index count = 30;
  const FrictionSystem system = build_system(figure_8(1));
  std::vector<Index> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), Index{0});
  const SectorContact whole = contact_of(system);
  const HarmonicResponse problem(one_harmonic(
      {spread(system.base, count, all), spread(system.damper, count, all),
       std::vector<SectorContact>(all.size(), {whole.stiffness / count, whole.slip_per_preload})}));
  const ForcedResponse scalar(system);
  const Branch found = trace_over_eta(problem, 1, 3.3, 4.2);
  const Branch expected = trace_over_eta(scalar, 1, 3.3, 4.2);
  REQUIRE(found.complete());
  for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
    const std::vector<BranchPoint> right = of_type(expected, type);
    const std::vector<BranchPoint> points = of_type(found, type);
    REQUIRE(points.size() == right.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK_THAT(points[i].parameters(0), WithinRel(right[i].parameters(0), 1e-9));
      CHECK_THAT(values_at(problem, points[i])(HarmonicResponse::Y),
                 WithinRel(values_at(scalar, right[i])(ForcedResponse::Y), 1e-8));
    }
  }
}

TEST_CASE("Two contacts of structures that do not touch slip as each does alone", "[contacts]") {
  SystemParameters other = figure_8(1);
  other.mass_ratio = 5.05;
  other.frequency_ratio = 4;
  const FrictionSystem first = build_system(figure_8(1));
  const FrictionSystem second = build_system(other);
  const Loss base{1e-4, 0};
  const Loss damper{2e-4, 0};
  const HarmonicResponse problem(
      one_harmonic({side_by_side(spread(first.base, 2, {0}), spread(second.base, 2, {1}), base),
                    side_by_side(spread(first.damper, 2, {0}), spread(second.damper, 2, {1}), damper),
                    {contact_of(first), contact_of(second)}}));
  // the same losses for each alone
  const auto alone = [&](const FrictionSystem& system) {
    const auto with = [](const ModalModel& model, const Loss& loss) {
      return ContactModes(1, spread(model, 1, {0}).modes(), loss);
    };
    return HarmonicResponse(
        one_harmonic({with(system.base, base), with(system.damper, damper), {contact_of(system)}}));
  };
  const HarmonicResponse one = alone(first);
  const HarmonicResponse two = alone(second);
  const Branch branch = trace_over_eta(problem, 10, 0.5, 6);
  CAPTURE(branch.explanation);
  REQUIRE(branch.complete());
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const BranchPoint& point = branch.points[i];
    seen.push_back(problem.describe(point.regime));
    if (i % 7 != 0) continue;
    const double eta = point.parameters(0);
    const auto amplitude = [&](const HarmonicResponse& single) {
      const continuation::Guess at = single.guess(eta, 10);
      Vector values;
      single.observe(at.unknowns, at.parameters, at.regime, values);
      return values(HarmonicResponse::Y);
    };
    CAPTURE(eta, point.regime);
    CHECK_THAT(values_at(problem, point)(HarmonicResponse::Y), WithinRel(amplitude(one), 1e-7));
    CHECK_THAT(values_at(problem, point)(index_of(continuation::observable_names(problem), "Y_contact_2")),
               WithinRel(amplitude(two), 1e-7));
  }
  for (const char* regime : {"stick", "slip 1", "slip 2", "slip"}) {
    CAPTURE(regime);
    CHECK(std::count(seen.begin(), seen.end(), regime) > 0);
  }
}

TEST_CASE("The force's power is what dampers and sliders take", "[contacts]") {
  RandomSystems draw(11);
  for (int i = 0; i < 20; ++i) {
    const auto modes = [&](bool loaded) {
      std::vector<ContactMode> list;
      for (int k = 0; k < 4; ++k) {
        ContactMode mode{draw.log_uniform(0.5, 8), ContactVector(3), 0};
        for (Index j = 0; j < 3; ++j) mode.shape(j) = {draw.uniform(-1, 1), draw.uniform(-1, 1)};
        if (loaded) mode.load = {draw.uniform(-1, 1), draw.uniform(-1, 1)};
        list.push_back(mode);
      }
      return list;
    };
    const Loss loss{draw.log_uniform(1e-4, 1e-2), 0};
    const std::vector<ContactMode> base = modes(true);
    const std::vector<ContactMode> damper = modes(false);
    std::vector<SectorContact> contacts;
    for (int k = 0; k < 3; ++k) contacts.push_back({draw.log_uniform(0.1, 100), draw.log_uniform(0.1, 10)});
    const HarmonicResponse problem(one_harmonic({{3, base, loss}, {3, damper, loss}, contacts}));
    const double preload = draw.log_uniform(1e-3, 1);
    const Branch branch = trace_over_eta(problem, preload, 0.4, 10);
    CAPTURE(i, branch.explanation);
    REQUIRE(branch.complete());
    for (std::size_t at = 0; at < branch.points.size(); at += 5) {
      const BranchPoint& point = branch.points[at];
      const double eta = point.parameters(0);
      ContactVector f(3);
      double friction = 0;
      for (Index k = 0; k < 3; ++k) {
        const SectorContact& contact = contacts[static_cast<std::size_t>(k)];
        const Complex r(point.unknowns(2 * k), point.unknowns(2 * k + 1));
        const double S = contact.slip_per_preload * preload;
        f(k) = contact.stiffness * hysteresis_coefficient(std::abs(r), S).phi * r;
        if (std::abs(r) > S) friction += 4 * contact.stiffness * S * (std::abs(r) - S);
      }
      // per cycle, from the modes' amplitudes q = (l + s^H f)/d: work of the load and loss of each mode
      double work = 0;
      double lost = 0;
      const auto add = [&](const std::vector<ContactMode>& list, double sign) {
        for (const ContactMode& mode : list) {
          const double square = mode.frequency * mode.frequency;
          const Complex d(square - eta * eta, loss.at(eta) * square);
          const Complex q = (mode.load + sign * mode.shape.dot(f)) / d;
          work += -std::numbers::pi * std::imag(std::conj(mode.load) * q);
          lost += std::numbers::pi * loss.at(eta) * square * std::norm(q);
        }
      };
      add(base, 1);
      add(damper, -1);
      CAPTURE(eta, point.regime);
      // a mode of loss 1e-4 multiplies the corrector's 1e-10 by 1e4 at its resonance
      CHECK_THAT(work, WithinRel(lost + friction, 1e-6));
    }
  }
}

TEST_CASE("All derivatives with several contacts are exact", "[contacts]") {
  RandomSystems draw(3);
  double worst = 0;
  for (unsigned bits = 0; bits < 8; ++bits) {
    const continuation::Regime regime = continuation::regime_of_bits(bits);
    std::vector<ContactMode> modes;
    for (int k = 0; k < 3; ++k) {
      ContactMode mode{
          draw.log_uniform(0.5, 5), ContactVector(3), {draw.uniform(-1, 1), draw.uniform(-1, 1)}};
      for (Index j = 0; j < 3; ++j) mode.shape(j) = {draw.uniform(-1, 1), draw.uniform(-1, 1)};
      modes.push_back(mode);
    }
    const ContactModes structure(3, modes, {0.02, 0.01});
    const HarmonicResponse problem(one_harmonic({structure, structure, {{1, 1}, {2, 0.5}, {0.3, 2}}}));
    Vector u(6);
    for (Index k = 0; k < 3; ++k) {
      const double S = 0.7 * (k == 0 ? 1 : k == 1 ? 0.5 : 2);
      const Complex r = std::polar(S * (regime[k] != 0 ? 1.5 + draw.uniform(0, 2) : draw.uniform(0.2, 0.8)),
                                   draw.uniform(-3, 3));
      u(2 * k) = r.real();
      u(2 * k + 1) = r.imag();
    }
    const Vector p = (Vector(2) << 2.2, 0.7).finished();
    const auto report = continuation::check_derivatives(problem, u, p, regime);
    CAPTURE(bits, report.where);
    CHECK(report.worst < 1e-7);
    worst = std::max(worst, report.worst);
  }
  CHECK(worst > 0);
}

TEST_CASE("A branch goes on where a second slip within the period turns it by more than a right angle",
          "[contacts][harmonics]") {
  const auto draw_modes = [](RandomSystems& draw, Index contacts, bool loaded, double damping) {
    std::vector<ContactMode> modes;
    const auto phasor = [&] {
      const double phase = draw.uniform(-3, 3);
      return std::polar(draw.uniform(0.1, 1), phase);
    };
    for (int k = 0; k < 4; ++k) {
      ContactMode mode{draw.uniform(0.5, 8), ContactVector(contacts), 0};
      for (Index i = 0; i < contacts; ++i) mode.shape(i) = phasor();
      if (loaded) mode.load = phasor();
      modes.push_back(mode);
    }
    return ContactModes(contacts, modes, Loss{.modal = 2 * damping});
  };
  RandomSystems draw(1);
  int corners = 0;
  for (int i = 0; i < 40; ++i) {
    const Index contacts = draw.integer(2, 4);
    HarmonicSystem system;
    system.orders = odd_up_to(5);
    const double of_base = draw.log_uniform(1e-4, 0.05);
    const double of_damper = draw.log_uniform(1e-4, 0.05);
    for (const int h : system.orders) {
      system.base.push_back(draw_modes(draw, contacts, h == 1, of_base));
      system.damper.push_back(draw_modes(draw, contacts, false, of_damper));
    }
    for (Index k = 0; k < contacts; ++k) {
      const double stiffness = draw.log_uniform(0.05, 50);
      system.contacts.push_back({stiffness, draw.log_uniform(0.05, 5)});
    }
    const double preload = draw.log_uniform(1e-3, 2);
    if (i != 36 && i != 39) continue;  // of which the corners are this sharp
    const HarmonicResponse problem(system);
    continuation::TraceOptions options = over_eta(0.4, i == 36 ? 0.6 : 1.2);
    options.extrema_of = {"Y"};
    const Branch branch = continuation::trace(problem, problem.guess(0.4, preload), options);
    CAPTURE(i, branch.explanation);
    CHECK(branch.complete());
    for (std::size_t k = 1; k < branch.points.size(); ++k) {
      const Vector here = branch.points[k].tangent.normalized();
      corners += static_cast<int>(here.dot(branch.points[k - 1].tangent.normalized()) < 0);
    }
  }
  CHECK(corners >= 2);
}

TEST_CASE("Systems of contacts that do not fit are refused", "[contacts]") {
  const FrictionSystem system = build_system(figure_8(1));
  const ContactModes one = spread(system.base, 1, {0});
  const ContactModes two = spread(system.base, 2, {0, 1});
  CHECK_THROWS_AS(HarmonicResponse(one_harmonic({one, two, {{1, 1}}})), std::invalid_argument);
  CHECK_THROWS_AS(HarmonicResponse(one_harmonic({two, two, {{1, 1}}})), std::invalid_argument);
  CHECK_THROWS_AS(HarmonicResponse(one_harmonic({one, one, {{0, 1}}})), std::invalid_argument);
  CHECK_THROWS_AS(ContactModes(0, {}, {}), std::invalid_argument);
  CHECK_THROWS_AS(ContactModes(2, one.modes(), {}), std::invalid_argument);
  CHECK_THROWS_AS(one_contact(system).guess(1, 0), std::invalid_argument);
}

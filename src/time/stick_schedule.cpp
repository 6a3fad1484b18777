#include "time/stick_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip {
namespace {

/// x modulo `period`, from 0.
double modulo(double x, double period) { return x - period * std::floor(x / period); }

}  // namespace

StickSchedule::StickSchedule(std::span<const StickPattern> contacts, Index nodes) : nodes_(nodes) {
  constexpr double same = 1e-14;
  const double whole = pi / static_cast<double>(nodes);
  std::vector<double> changes;
  double start = 0;
  for (const StickPattern& contact : contacts) {
    for (const HysteresisLoop::Arc& arc : contact.arcs) {
      const double end = arc.begin + arc.width;
      if (changes.empty()) start = end;
      for (const double change : {arc.begin, end}) changes.push_back(modulo(change - start, whole));
    }
  }
  changes.push_back(whole);
  std::sort(changes.begin(), changes.end());
  double from = 0;
  for (const double to : changes) {
    if (!(to - from > same * whole)) continue;
    intervals_.push_back({start + from, to - from, sticking(contacts, start + 0.5 * (from + to))});
    from = to;
  }
  for (Slot slot : intervals_.front().sticking) {
    slot.node = (slot.node + 1) % nodes;
    behind_.push_back(slot);
  }
}

std::vector<StickSchedule::Slot> StickSchedule::sticking(std::span<const StickPattern> contacts,
                                                         double angle) const {
  std::vector<Slot> slots;
  for (std::size_t contact = 0; contact < contacts.size(); ++contact) {
    const std::vector<HysteresisLoop::Arc>& arcs = contacts[contact].arcs;
    for (std::size_t arc = 0; arc < arcs.size(); ++arc) {
      for (Index node = 0; node < nodes_; ++node) {
        const double phase = angle - pi * static_cast<double>(node) / static_cast<double>(nodes_);
        if (modulo(phase - arcs[arc].begin, pi) < arcs[arc].width) slots.push_back({contact, arc, node});
      }
    }
  }
  return slots;
}

std::vector<double> law_changes(const StickSchedule::Interval& interval, std::span<const StickPattern> others,
                                Index nodes) {
  constexpr double narrow = 1e-12;  // less would be rounding
  std::vector<double> ends = {interval.begin};
  for (Index node = 0; node < nodes; ++node) {
    const double lag = pi * static_cast<double>(node) / static_cast<double>(nodes);
    for (const StickPattern& other : others) {
      for (const VaryingStiffness::Arc& arc : other.stiffness.arcs) {
        const double end = modulo(arc.begin + lag - interval.begin, pi);
        if (end < interval.width) ends.push_back(interval.begin + end);
      }
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a < narrow; }),
             ends.end());
  ends.push_back(interval.begin + interval.width);
  return ends;
}

}  // namespace arcslip

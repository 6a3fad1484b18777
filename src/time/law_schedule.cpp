#include "time/law_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip {
namespace {

constexpr double narrow = 1e-14;  // of the schedule: less would be rounding

/// x modulo `period`, from 0.
double modulo(double x, double period) { return x - period * std::floor(x / period); }

}  // namespace

LawSchedule::LawSchedule(std::span<const DisturbedLaw> laws, Index nodes, double turn)
    : laws_(laws), nodes_(nodes), turn_(turn) {
  const double whole = turn / static_cast<double>(nodes);
  std::vector<double> angles;
  for (const DisturbedLaw& law : laws) {
    for (const DisturbedLaw::Memory& memory : law.memories) {
      for (const double angle : {memory.begin + memory.width, memory.begin}) angles.push_back(angle);
    }
    if (law.pieces.size() < 2) continue;
    for (const DisturbedLaw::Piece& piece : law.pieces) angles.push_back(piece.begin);
  }
  const double start = angles.empty() ? 0 : angles.front();
  std::vector<double> changes;
  for (const double angle : angles) changes.push_back(modulo(angle - start, whole));
  changes.push_back(whole);
  std::sort(changes.begin(), changes.end());
  double from = 0;
  for (const double to : changes) {
    if (!(to - from > narrow * whole)) continue;
    intervals_.push_back({start + from, to - from, kept(start + from, to - from)});
    from = to;
  }
  for (Slot slot : intervals_.front().slots) {
    slot.node = (slot.node + 1) % nodes;
    behind_.push_back(slot);
  }
}

std::vector<LawSchedule::Slot> LawSchedule::kept(double begin, double width) const {
  std::vector<Slot> slots;
  const double middle = begin + 0.5 * width;
  for (std::size_t element = 0; element < laws_.size(); ++element) {
    const std::vector<DisturbedLaw::Memory>& all = laws_[element].memories;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (Index node = 0; node < nodes_; ++node) {
        const double age = modulo(phase(middle, node) - all[i].begin, turn_);
        if (age < all[i].width) slots.push_back({element, i, node, age < 0.5 * width + 4 * narrow * turn_});
      }
    }
  }
  return slots;
}

const DisturbedLaw::Piece& LawSchedule::piece(const Interval& interval, std::size_t element,
                                              Index node) const {
  const std::vector<DisturbedLaw::Piece>& all = laws_[element].pieces;
  const double first = all.front().begin;
  const double behind = modulo(phase(interval.begin + 0.5 * interval.width, node) - first, turn_);
  const auto found = std::partition_point(all.begin(), all.end() - 1, [&](const DisturbedLaw::Piece& one) {
    return behind >= one.begin - first + one.width;
  });
  return *found;
}

double LawSchedule::offset(const Interval& interval, std::size_t element, Index node) const {
  const double middle = phase(interval.begin + 0.5 * interval.width, node);
  const double first = laws_[element].pieces.front().begin;
  return phase(0, node) - turn_ * std::floor((middle - first) / turn_);
}

}  // namespace arcslip

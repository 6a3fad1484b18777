// Pieces in the order of two rounds.

#include <fmt/format.h>

#include <algorithm>

#include "arcslip/continuation/cycles/piecewise_cycle.hpp"

namespace arcslip::continuation {
namespace {

class TwoRounds : public PiecewiseField {
 public:
  explicit TwoRounds(std::shared_ptr<const PiecewiseField> once) : once_(std::move(once)) {}

  Index size() const override { return once_->size(); }
  Index pieces() const override { return 2 * once_->pieces(); }
  Index told() const override { return once_->told(); }
  std::vector<std::string> names() const override { return once_->names(); }
  std::vector<std::string> parameter_names() const override { return once_->parameter_names(); }

  /// Those of the second round with the next number that is free.
  std::vector<std::string> piece_names() const override {
    const std::vector<std::string> one_round = once_->piece_names();
    std::vector<std::string> all = one_round;
    const auto is_among = [](const std::vector<std::string>& names, const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const std::string& name : one_round) {
      const bool is_numbered = name.find_first_not_of("0123456789", name.find_last_of('_') + 1) == name.npos;
      const std::string begins = is_numbered ? name.substr(0, name.find_last_of('_')) : name;
      int number = 2;
      while (is_among(all, fmt::format("{}_{}", begins, number))) ++number;
      all.push_back(fmt::format("{}_{}", begins, number));
    }
    return all;
  }

  double time_at(const Vector& u, const Vector& p) const override { return once_->time_at(u, p); }
  bool velocity(Index piece, const Vector& u, const Vector& p, const FieldValues& out) const override {
    return once_->velocity(piece % once_->pieces(), u, p, out);
  }
  bool border(Index piece, const Vector& u, const Vector& p, const FieldValues& out) const override {
    return once_->border(piece % once_->pieces(), u, p, out);
  }
  bool jump(Index piece, const Vector& u, const Vector& p, const FieldValues& out) const override {
    return once_->jump(piece % once_->pieces(), u, p, out);
  }
  double turn(Index unknown) const override { return once_->turn(unknown); }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    once_->scale(u, p, unknowns, parameters);
  }

 private:
  std::shared_ptr<const PiecewiseField> once_;
};

}  // namespace

std::shared_ptr<const PiecewiseField> two_rounds_of(std::shared_ptr<const PiecewiseField> once) {
  return std::make_shared<TwoRounds>(std::move(once));
}

}  // namespace arcslip::continuation

#include "app/crew.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "results/output.hpp"

namespace arcslip {

struct Crew::Processes {};

Crew::Crew() = default;
Crew::~Crew() = default;

bool Crew::leads() const { return true; }

std::size_t Crew::default_jobs() const { return std::max(1U, std::thread::hardware_concurrency()); }

std::size_t Crew::threads(std::size_t jobs) const { return jobs; }

bool Crew::agree(const std::string& error) const {
  if (!error.empty()) complain(error);
  return error.empty();
}

std::size_t Crew::compute(const StudyCase& study, std::size_t jobs, PendingDesigns& pending,
                          const std::function<void(const FinishedDesign&)>& keep,
                          const std::function<bool()>& go_on) {
  StudyWorkers workers(study, jobs);
  return arcslip::compute(workers, pending, keep, go_on);
}

void Crew::dismiss(int /*status*/) {}

int Crew::assist(const StudyCase& /*study*/, std::size_t /*jobs*/) {
  throw std::logic_error("a process alone leads");
}

}  // namespace arcslip

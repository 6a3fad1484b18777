#pragma once

// The processes that work on a study together: this one alone or, where the program is built with MPI and
// started by mpirun, one that leads, hands out designs and writes, and others that compute. crew.cpp is for
// the one, crew_mpi.cpp for both.

#include <functional>
#include <memory>
#include <string>

#include "results/study_run.hpp"

namespace arcslip {

class Crew {
 public:
  Crew();
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  Crew(Crew&&) = delete;
  Crew& operator=(Crew&&) = delete;

  /// Whether this process writes and speaks.
  bool leads() const;
  /// Threads of a process that is not told how many: all cores for one alone, one among several.
  std::size_t default_jobs() const;
  /// Threads that compute in all processes, so many in each.
  std::size_t threads(std::size_t jobs) const;
  /// Whether none has an error, "" being none; the first one's is printed on stderr before anyone goes on.
  bool agree(const std::string& error) const;

  /// As compute() of study_run.hpp, with the others' help. For the one that leads.
  std::size_t compute(const StudyCase& study, std::size_t jobs, PendingDesigns& pending,
                      const std::function<void(const FinishedDesign&)>& keep,
                      const std::function<bool()>& go_on);
  /// Ends the others' work, if it has not ended, and tells them the exit status.
  void dismiss(int status);

  /// Computes what the one that leads hands out, until dismissed. Returns the exit status.
  int assist(const StudyCase& study, std::size_t jobs);

 private:
  struct Processes;
  std::unique_ptr<Processes> processes_;
};

}  // namespace arcslip

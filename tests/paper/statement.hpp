#pragma once

// What the paper says of its figures, each statement with what is measured for it.

#include <string>
#include <utility>
#include <vector>

namespace arcslip::testing {

class Statement {
 public:
  Statement(int number, std::string words) : number_(number), words_(std::move(words)) {}

  /// A measured value beside what is required of it.
  void require(bool holds, std::string what, std::string measured, std::string required) {
    findings_.push_back({holds, std::move(what), std::move(measured), std::move(required)});
  }

  /// What else was measured: where the model says more than the words, or something else.
  void note(std::string text) { notes_.push_back(std::move(text)); }

  bool holds() const;

  /// The words, the findings in columns, the verdict and the notes.
  std::string text() const;

 private:
  struct Finding {
    bool holds;
    std::string what;
    std::string measured;
    std::string required;
  };

  int number_;
  std::string words_;
  std::vector<Finding> findings_;
  std::vector<std::string> notes_;
};

Statement peaks_and_phases();           // 1: figures 8 and 9
Statement best_of_five_preloads();      // 2: figure 8
Statement stick_and_slip();             // 3: figure 10
Statement mass_ratio_and_preload();     // 4: figure 11
Statement separated_frequencies();      // 5: figure 12
Statement convergence_of_rods();        // 6: section 4
Statement damper_driven_by_the_base();  // 7: section 1

}  // namespace arcslip::testing

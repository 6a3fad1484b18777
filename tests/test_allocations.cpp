// The corrector allocates nothing: counted through the global operator new of this program.

#include <atomic>
#include <cstdlib>
#include <new>

#include "arcslip/continuation/stepper.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

using namespace arcslip;

TEST_CASE("Steps and corrections allocate nothing") {
  const problems::ForcedResponse problem(build_system(testing::figure_8(1)));
  continuation::Corrector corrector(problem, problems::ForcedResponse::eta, {});
  continuation::Stepper stepper(problem, corrector, {problems::ForcedResponse::Y}, 0.1);
  const continuation::Guess guess = problem.guess(0.5, 1);
  REQUIRE(stepper.start(guess.unknowns, guess.parameters, guess.regime, 1) ==
          continuation::Correction::converged);

  const long before = allocations;
  int kept = 0;
  for (int i = 0; i < 20; ++i) {
    kept += static_cast<int>(stepper.attempt(continuation::Hold::tangent, 0.05));
    stepper.probe(0.02);
    stepper.advance();
  }
  const long during = allocations - before;
  CHECK(kept == 20);
  CHECK(corrector.work().iterations >= 20);
  CHECK(during == 0);

  const double* one = new double(1);  // the count counts
  CHECK(allocations > before);
  delete one;
}

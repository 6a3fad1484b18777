// Memory that runs out is told from what is wrong with a system.

#include <cstdlib>
#include <new>

#include "arcslip/problems/ridges/preload_study.hpp"
#include "catch.hpp"

namespace {

thread_local long allocations_left = -1;  // none is counted while it is negative

}  // namespace

void* operator new(std::size_t size) {
  if (allocations_left == 0) throw std::bad_alloc();
  if (allocations_left > 0) --allocations_left;
  if (void* memory = std::malloc(size == 0 ? 1 : size); memory != nullptr) return memory;
  throw std::bad_alloc();
}

void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

using namespace arcslip;

TEST_CASE("Memory that runs out in a study of preloads is not its failure") {
  for (const long allocations : {0, 1, 10, 50, 100, 200}) {
    bool ran_out = false;
    std::string failure;
    const problems::PreloadRange range{0.1, 1, 3, 5, {}};
    allocations_left = allocations;
    try {
      failure = problems::study_preload({}, range).failure;
    } catch (const std::bad_alloc&) {
      ran_out = true;
    }
    allocations_left = -1;
    CAPTURE(allocations, failure);
    CHECK(ran_out);
  }
}

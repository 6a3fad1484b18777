#include "app/interrupt.hpp"

#include <semaphore.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "app/commands.hpp"

namespace arcslip {
namespace {

constexpr std::chrono::milliseconds patience(500);

volatile std::sig_atomic_t noted = 0;
sem_t notices;
std::mutex forcing;
const std::function<void()>* before_the_end = nullptr;

extern "C" void note_interrupt(int signal) {
  noted = 1;
  sem_post(&notices);
  std::signal(signal, SIG_DFL);
}

void wait_for_interrupt() {
  while (sem_wait(&notices) != 0) {
  }
  std::this_thread::sleep_for(patience);
  const std::scoped_lock lock(forcing);
  if (before_the_end == nullptr || !*before_the_end) return;
  _exit(guarded([] {
    (*before_the_end)();
    return status::incomplete_branch;
  }));
}

}  // namespace

void catch_interrupts() {
  sem_init(&notices, 0, 0);
  try {
    std::thread(wait_for_interrupt).detach();
  } catch (const std::system_error&) {
    // Without a thread the work ends where it asks.
  }
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
  // A terminal that is closed ends no program that was started to outlive it.
  if (std::signal(SIGHUP, note_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool interrupted() { return noted != 0; }

BeforeTheEnd::BeforeTheEnd(std::function<void()> act) : act_(std::move(act)) {
  const std::scoped_lock lock(forcing);
  outer_ = before_the_end;
  before_the_end = &act_;
}

BeforeTheEnd::~BeforeTheEnd() {
  const std::scoped_lock lock(forcing);
  before_the_end = outer_;
}

Undisturbed::Undisturbed() { forcing.lock(); }

Undisturbed::~Undisturbed() { forcing.unlock(); }

}  // namespace arcslip

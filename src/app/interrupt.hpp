#pragma once

// What ends the program before its work is done: Ctrl-C, a request to terminate, a terminal that is closed.
//
// The work asks whether it is to end, and ends by itself. Where it does not within half a second, in a long
// factorisation or while a file is read, another thread does what has to be done before the end, by force.

#include <functional>

namespace arcslip {

/// From now on an interrupt is noted; a second one ends the program at once.
void catch_interrupts();

bool interrupted();

/// Thrown by work that ends without a result.
struct Interrupted {};

/// What is done before the program is ended by force: as long as it lives, and in place of what was to be
/// done before it; the last one made is the first to go. Without any, or with an empty one, the program ends
/// by itself.
class BeforeTheEnd {
 public:
  explicit BeforeTheEnd(std::function<void()> act);
  /// Waits for the end of a program that is being ended by force.
  ~BeforeTheEnd();
  BeforeTheEnd(const BeforeTheEnd&) = delete;
  BeforeTheEnd& operator=(const BeforeTheEnd&) = delete;
  BeforeTheEnd(BeforeTheEnd&&) = delete;
  BeforeTheEnd& operator=(BeforeTheEnd&&) = delete;

 private:
  std::function<void()> act_;
  const std::function<void()>* outer_;
};

/// While it is there, nothing is done by force.
class Undisturbed {
 public:
  Undisturbed();
  ~Undisturbed();
  Undisturbed(const Undisturbed&) = delete;
  Undisturbed& operator=(const Undisturbed&) = delete;
  Undisturbed(Undisturbed&&) = delete;
  Undisturbed& operator=(Undisturbed&&) = delete;
};

}  // namespace arcslip

#ifndef FACEWIRE_APP_ERROR_H_
#define FACEWIRE_APP_ERROR_H_

#include <stdexcept>
#include <string>

namespace facewire::app {

// Starting up and the operator's commands report by exception; core, hal and the running service do
// not.

// What the person gave is wrong: says what, where, and what would be right. Exit code 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Something failed at work. Exit code 1.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Calls `part`; what is wrong with its input joins what was wrong before, on a line of its own.
template <class Part>
void Collect(std::string& problems, Part part) {
  try {
    part();
  } catch (const BadInput& e) {
    if (!problems.empty()) problems += '\n';
    problems += e.what();
  }
}

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ERROR_H_

#ifndef FACEWIRE_APP_OBSERVER_H_
#define FACEWIRE_APP_OBSERVER_H_

#include "app/host_line.h"
#include "app/journal.h"
#include "app/service.h"
#include "app/stop_latch.h"
#include "app/supervisor.h"

namespace facewire::app {

// Watches the service from outside: feeds systemd's watchdog while all is well, and tells systemd
// and the journal what has changed, at most once a second. Allocates nothing.
class Observer {
 public:
  // All borrowed.
  Observer(Journal& journal, Supervisor& supervisor, const StopLatch& latch) noexcept
      : journal_(journal), supervisor_(supervisor), latch_(latch) {}

  // After every tick. That it is called is what shows that the loop does not hang.
  void Look(const Service& service, Time now) noexcept;

  // From the start of the process to the first search for a face; zero until then.
  Duration searching_after() const noexcept { return searching_after_; }

 private:
  void Feed(const Service& service, Time now) noexcept;
  void TellState(const Service& service) noexcept;
  void TellSystemd(const Service& service) noexcept;

  Journal& journal_;
  Supervisor& supervisor_;
  const StopLatch& latch_;
  Time next_beat_{};
  Time next_look_{};
  bool starving_ = false;
  ServiceState told_ = ServiceState::kStarting;
  Duration searching_after_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_OBSERVER_H_

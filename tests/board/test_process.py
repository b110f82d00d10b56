"""The process dies, hangs, or is told nonsense."""
from case import PATIENCE, BoardTest
from machine import wait_until
from service import CONFIG

# WatchdogSec of the board's unit, and the time that systemd gives a process to end by its signal.
WATCHDOG_S = 30
ABORT_S = 60

BROKEN = """
[camera]
device = 5
[host]
boud = 9600
[states]
hold_ms = -1
"""


class Process(BoardTest):
    def setUp(self):
        self.wait_for_tracking()

    def restarts_from_neutral(self, fall, timeout):
        """Lets it `fall`; the seconds until the next process sent its first pose, which must be neutral."""
        pid, restarts = self.service.pid(), self.service.restarts()
        mark = self.line.mark()
        fell = float(self.agent.read("cut -d' ' -f1 /proc/uptime"))
        fall(pid)
        wait_until("systemd to start another", lambda: self.service.restarts() > restarts and self.service.pid(), timeout)
        self.assertNotEqual(self.service.pid(), pid)
        first = self.line.wait_for("a pose of the next process", lambda pose: pose.sent_s > self.service_began(), PATIENCE, mark)
        self.assertEqual(first.state, "starting")
        self.assertLess(self.line.off_neutral(first), 0.001)
        self.wait_for_tracking(since=mark)
        return first.sent_s - fell

    def service_began(self):
        if not hasattr(self, "_began"):
            self._began = self.service.started_s()
        return self._began

    def test_01_a_killed_service_is_started_again_and_begins_at_neutral(self):
        took = self.restarts_from_neutral(lambda pid: self.agent.read(f"kill -KILL {pid}"), PATIENCE)
        self.figure(f"first pose {took:.1f} s after kill -9")

    def test_02_a_service_that_hangs_is_found_by_the_watchdog(self):
        journal = self.service.journal_mark()
        took = self.restarts_from_neutral(lambda pid: self.agent.read(f"kill -STOP {pid}"), WATCHDOG_S + ABORT_S + PATIENCE)
        self.assertIn("Watchdog timeout", self.service.journal(journal))
        self.figure(f"first pose {took:.1f} s after it hung, with WatchdogSec={WATCHDOG_S}")

    def test_03_a_broken_file_is_refused_with_every_error_and_the_show_goes_on(self):
        pid, journal, mark = self.service.pid(), self.service.journal_mark(), self.line.mark()
        good = self.agent.read(f"cat {CONFIG}")
        try:
            self.agent.write(CONFIG, BROKEN)
            self.agent.read(f"kill -HUP {pid}")
            said = self.service.wait_for_words("running on as before", PATIENCE, journal)
        finally:
            self.agent.write(CONFIG, good + "\n")
        for wrong in ("device", "boud", "hold_ms"):
            self.assertIn(wrong, said)
        self.assertEqual(self.service.pid(), pid)
        self.line.wait_for_state("tracking", timeout=PATIENCE)
        self.assertNotIn("stopped", {pose.state for pose in self.line.since(mark)})
        self.service.do("reload")
        self.service.wait_for_words("reloaded", PATIENCE, journal)

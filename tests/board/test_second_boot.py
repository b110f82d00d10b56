"""A board that lost its power and is switched on again, now with its camera by libcamera; then its kernel hangs."""
from case import BOOT_S, BoardTest
from service import CONFIG
from tracking import Tracking

NEUTRAL = "/var/lib/facewire/performer.neutral"


class OnLibcamera(Tracking, BoardTest):
    camera = "libcamera:0"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        machine = cls.machine
        machine.agent.read(f"sed -i 's|^device = .*|device = \"{cls.camera}\"|' {CONFIG}; sync")
        cls.neutral = machine.agent.run(f"sha256sum {NEUTRAL}").out
        machine.keep_journal()
        machine.power_cut()
        machine.power_on()
        machine.wait_until_up(BOOT_S)

    def test_04_the_neutral_is_as_it_was_before_the_power_cut(self):
        self.assertEqual(self.agent.run(f"sha256sum {NEUTRAL}").out, self.neutral)


class Watchdog(BoardTest):
    def test_05_a_kernel_that_hangs_is_reset_by_the_hardware(self):
        self.machine.keep_journal()
        self.agent.read("sysctl -w kernel.panic=0")
        self.agent.start("echo c > /proc/sysrq-trigger")
        event = self.machine.monitor.wait_for_event("WATCHDOG", 120)
        self.figure(f"the watchdog wants: {event['action']}")
        self.machine.power_cut()

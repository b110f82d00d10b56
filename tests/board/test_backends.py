"""The project's own test programs for hardware, built for ARM, on the board's devices."""
from case import PATIENCE, BoardTest
from machine import wait_until

PROGRAMS = "/usr/local/lib/facewire-tests"


class Backends(BoardTest):
    def passes(self, program, variable):
        answer = self.agent.run(f"{variable} {PROGRAMS}/{program} --gtest_brief=1 | tail -n 40", PATIENCE)
        self.assertRegex(answer.out, r"\[  PASSED  \]", answer.out)
        self.assertNotIn("FAILED", answer.out)
        self.assertNotIn("SKIPPED", answer.out)
        self.figure(answer.out.split("[  PASSED  ] ")[1].splitlines()[0].rstrip("."))

    def test_01_gpio_lines_do_what_their_interface_says(self):
        self.passes("hal_gpiod_test", "FACEWIRE_TEST_GPIO=spare,$(echo /sys/devices/platform/gpio-sim.1/gpiochip*)")

    def test_02_a_board_that_is_a_usb_device_has_a_serial_line_to_its_computer(self):
        # dummy_hcd is a cable from a device controller to a host controller of the same machine.
        self.agent.read("modprobe dummy_hcd && systemctl start facewire-gadget.service")
        try:
            for port, peer in (("ttyACM0", "ttyGS0"), ("ttyGS0", "ttyACM0")):
                wait_until(port, lambda: self.agent.run(f"test -c /dev/{port}").code == 0, PATIENCE)
                self.passes("hal_serialport_test", f"FACEWIRE_TEST_TTY=/dev/{port},/dev/{peer}")
        finally:
            self.agent.read("systemctl stop facewire-gadget.service; modprobe -r dummy_hcd", PATIENCE)

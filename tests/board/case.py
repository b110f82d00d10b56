"""What every test of the board has at hand."""
import unittest

from service import Service

# Emulated, the networks take seconds for a picture, and a busy host doubles that. Nothing here asserts speed.
PATIENCE = 240
BOOT_S = 600

# The failsafe contract of files/etc/facewire/facewire.toml and, where it says nothing, of the defaults.
HOLD_S, EASE_S, REST_AFTER_S = 0.4, 1.5, 3.0
# What two emulated processors may take longer, besides.
ALLOWANCE_S = 2.0


class BoardTest(unittest.TestCase):
    machine = None  # set before the first test
    figures = {}    # test id -> what it measured

    @classmethod
    def setUpClass(cls):
        if not cls.machine.is_on:
            cls.machine.power_on()
            cls.machine.wait_until_up(BOOT_S)

    @property
    def agent(self):
        return self.machine.agent

    @property
    def line(self):
        return self.machine.line

    @property
    def webcam(self):
        return self.machine.webcam

    @property
    def service(self):
        return Service(self.machine.agent)

    def figure(self, text):
        """A measurement, printed beside the test's name."""
        self.figures.setdefault(self.id(), []).append(text)

    def wait_for_tracking(self, since=None):
        return self.line.wait_for_state("tracking", timeout=PATIENCE, since=since)


class StillFaceTest(BoardTest):
    """A performer who holds still, so that calibrating succeeds."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.machine.webcam.show("still")

    @classmethod
    def tearDownClass(cls):
        cls.machine.webcam.show("talking")

    def setUp(self):
        self.wait_for_tracking()

    def calibrate(self):
        """As the operator asks for it. Eight pictures within ten seconds may be too many for a busy host: once more then."""
        for _ in range(8):
            answer = self.agent.run("facewire calibrate --timeout 60", PATIENCE)
            if "no face" not in answer.out:
                break
        return answer

"""What every test of the board has at hand."""
import unittest

from service import Service

# Emulated, the networks take seconds for a picture, and a busy host doubles that. Nothing here asserts speed.
PATIENCE = 180


class BoardTest(unittest.TestCase):
    machine = None  # set before the first test
    figures = {}    # test id -> what it measured

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

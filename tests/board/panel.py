"""The switches and lamps at the board's pins, which gpio-sim plays (files/usr/local/sbin/board-gpio)."""

SIM = "/sys/devices/platform/gpio-sim.0"
LINES = {"estop": 0, "button": 1, "led": 2, "servo": 3}


class Panel:
    def __init__(self, agent):
        self._agent = agent
        self._folder = None

    def _line(self, name):
        if not self._folder:
            self._folder = self._agent.read(f"echo {SIM}/gpiochip*")
        return f"{self._folder}/sim_gpio{LINES[name]}"

    def set(self, name, high):
        """The level that the outside world gives an input."""
        self._agent.read(f"echo pull-{'up' if high else 'down'} > {self._line(name)}/pull")

    def level(self, name):
        """Of an output."""
        return self._agent.read(f"cat {self._line(name)}/value") == "1"

    # Normally closed: its contact pulls the line down.
    def open_estop(self):
        """When it had opened, on the board's clock."""
        return float(self._agent.read(f"echo pull-up > {self._line('estop')}/pull; cut -d' ' -f1 /proc/uptime"))

    def close_estop(self):
        self.set("estop", False)

    def press(self, seconds):
        """The button, whose contact pulls its line down."""
        pull = f"{self._line('button')}/pull"
        self._agent.read(f"echo pull-down > {pull}; sleep {seconds}; echo pull-up > {pull}")

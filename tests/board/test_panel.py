"""The emergency stop, the button, the lamp and the servos' power."""
from case import PATIENCE, StillFaceTest
from machine import wait_until
from panel import Panel

# A picture takes a second or more here, and between two pictures nobody looks at the button. A press has to be seen twice
# to count as one and to end before two seconds to be a short one: not every short press is seen.
SHORT_PRESS_S, LONG_PRESS_S = 1.2, 12


class Buttons(StillFaceTest):
    def setUp(self):
        super().setUp()
        self.panel = Panel(self.agent)

    def tearDown(self):
        self.panel.close_estop()
        if self.line.poses[-1].state == "stopped":
            self.panel.press(LONG_PRESS_S)
        self.wait_for_tracking()

    def test_01_servos_have_power_while_all_is_well(self):
        wait_until("the servos' power", lambda: self.panel.level("servo"), PATIENCE)

    def test_02_a_short_press_calibrates(self):
        journal = self.service.journal_mark()
        for presses in range(1, 9):
            self.panel.press(SHORT_PRESS_S)
            try:
                said = self.service.wait_for_words("neutral", 30, journal)
                break
            except TimeoutError:  # nobody looked twice while it was down
                continue
        else:
            self.fail(f"{presses} presses, and no word of a neutral")
        self.figure(f"{said.strip().splitlines()[-1]}; presses until one was seen: {presses}")

    def test_03_an_open_estop_stops_all_motion_within_a_tick(self):
        mark = self.line.mark()
        opened = self.panel.open_estop()
        stopped = self.line.wait_for_state("stopped", timeout=PATIENCE, since=mark)
        late = [pose for pose in self.line.since(mark) if pose.sent_s > opened and pose.state != "stopped"]
        self.figure(f"{len(late)} moving poses after it had opened")
        # One may have been in the making.
        self.assertLessEqual(len(late), 1)
        later = self.line.mark()
        self.line.wait_for("ten more poses", lambda pose: self.line.mark() >= later + 10, PATIENCE)
        for pose in self.line.since(later):
            self.assertEqual(pose.state, "stopped")
            self.assertEqual(pose.steps, stopped.steps, "it moved")
        self.assertFalse(self.panel.level("servo"))

    def test_04_an_estop_outlives_its_contact_and_a_restart_until_it_is_released(self):
        self.panel.open_estop()
        self.line.wait_for_state("stopped", timeout=PATIENCE)
        self.panel.close_estop()
        self.service.do("restart")
        mark = self.line.mark()
        self.line.wait_for("ten poses", lambda pose: self.line.mark() >= mark + 10, PATIENCE, mark)
        self.assertEqual({pose.state for pose in self.line.since(mark)}, {"stopped"})
        pressed = self.line.mark()
        self.panel.press(LONG_PRESS_S)
        self.line.wait_for_state("starting", timeout=PATIENCE, since=pressed)

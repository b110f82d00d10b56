"""Cables that are pulled out and put back, while the show runs."""
from case import ALLOWANCE_S, EASE_S, HOLD_S, PATIENCE, REST_AFTER_S, BoardTest


class Cables(BoardTest):
    def setUp(self):
        self.wait_for_tracking()
        self.pid = self.service.pid()

    def tearDown(self):
        self.webcam.tell("resume")
        self.webcam.tell("plug")
        if not self.machine.has_serial:
            self.machine.plug_serial()
        self.wait_for_tracking()
        self.assertEqual(self.service.pid(), self.pid, "the service was restarted")

    def test_01_a_camera_pulled_in_mid_stream_eases_the_face_to_rest(self):
        mark = self.line.mark()
        self.webcam.tell("unplug")
        resting = self.line.wait_for_state("resting", timeout=PATIENCE, since=mark)
        poses = self.line.since(mark)
        states = list(dict.fromkeys(pose.state for pose in poses))
        self.assertEqual(states[-4:], ["holding", "easing", "searching", "resting"])
        # By the board's own clock: what the host saw, and when it was sent.
        first = {pose.state: pose.sent_s for pose in reversed(poses)}
        held, eased, rested = (first["easing"] - first["holding"], first["searching"] - first["easing"],
                               resting.sent_s - first["easing"])
        self.figure(f"Holding {held:.2f} s, Easing {eased:.2f} s, Resting {rested:.2f} s after its beginning")
        self.assertLess(held, HOLD_S + ALLOWANCE_S)
        self.assertGreater(eased, EASE_S - 0.05)
        self.assertLess(eased, EASE_S + ALLOWANCE_S)
        self.assertGreater(rested, REST_AFTER_S - 0.05)
        self.assertLess(rested, REST_AFTER_S + ALLOWANCE_S)
        self.assertLess(self.line.off_neutral(resting), 0.001)
        held_poses = [pose.steps for pose in poses if pose.state == "holding"]
        self.assertTrue(all(steps == held_poses[0] for steps in held_poses), "a held face moved")

    def test_02_a_camera_put_back_is_followed_again(self):
        self.webcam.tell("unplug")
        self.line.wait_for_state("easing", timeout=PATIENCE)
        mark = self.line.mark()
        self.webcam.tell("plug")
        tracking = self.wait_for_tracking(since=mark)
        self.figure(f"tracking {tracking.sent_s - self.line.since(mark)[0].sent_s:.1f} s later")

    def test_03_a_camera_that_falls_silent_is_a_fault_and_is_restarted(self):
        mark = self.line.mark()
        self.webcam.tell("stall")
        self.line.wait_for_state("fault", timeout=PATIENCE, since=mark)
        self.webcam.tell("resume")
        self.wait_for_tracking()

    def test_04_a_serial_line_pulled_and_put_back_carries_poses_again(self):
        journal = self.service.journal_mark()
        self.machine.pull_serial()
        self.service.wait_for_words("the line to the host is gone", PATIENCE, journal)
        mark = self.line.mark()
        self.machine.plug_serial()
        back = self.line.wait_for("a pose", lambda pose: True, timeout=PATIENCE, since=mark)
        # Nobody knows what the far end did meanwhile, so it all begins at neutral.
        self.assertLess(self.line.off_neutral(back), 0.001)
        self.wait_for_tracking(since=mark)

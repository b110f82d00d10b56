"""What a board that was switched on must show, whichever library its camera comes through."""
from case import PATIENCE

JAW_OPENS_DEG = 3.0  # less may be jitter; speech opens it by 5 to 15


class Tracking:
    camera = None  # the address, as in facewire.toml

    def test_01_poses_arrive_after_power_on_without_a_hand(self):
        first = self.line.wait_for("a pose", lambda pose: True, timeout=PATIENCE, since=0)
        self.figure(f"first bytes {first.heard - self.machine.booted_at:.0f} s after power-on")
        self.assertIn(f'device = "{self.camera}"', self.agent.read("cat /etc/facewire/facewire.toml"))
        began = self.service.started_s()
        self.figure(f"unit start to first pose {first.sent_s - began:.2f} s")
        searching = self.line.wait_for_state("searching", "tracking", timeout=PATIENCE, since=0)
        self.figure(f"to Searching {searching.sent_s - began:.2f} s")
        tracking = self.wait_for_tracking(since=0)
        self.figure(f"to the first tracked pose {tracking.sent_s - began:.2f} s")
        # The host was there before the board: it has everything, and the first thing is neutral.
        self.assertLess(self.line.off_neutral(first), 0.001)

    def test_02_the_face_is_tracked_and_the_jaw_moves(self):
        mark = self.line.mark()

        def opening():
            poses = [p for p in self.line.since(mark) if p.state == "tracking"]
            values = [self.line.value(p, "jaw.pitch") for p in poses]
            return max(values) - min(values) if values else 0, poses

        self.line.wait_for("the jaw to move", lambda _: opening()[0] > JAW_OPENS_DEG, timeout=PATIENCE)
        self.line.wait_for("ten tracked poses", lambda _: len(opening()[1]) >= 10, timeout=PATIENCE)
        span, poses = opening()
        pictures = {p.frame_seq for p in poses}
        took = poses[-1].sent_s - poses[0].sent_s
        self.figure(f"jaw.pitch spans {span:.1f} degrees over {len(poses)} tracked poses")
        self.figure(f"{(len(pictures) - 1) / took:.2f} pictures/s on the emulated board")

    def test_03_what_the_service_takes_of_the_board_is_printed(self):
        resident, threads = self.service.memory()
        self.figure(f"RSS {resident:.1f} MiB, {threads} threads")
        exposure = self.agent.read("systemd-analyze security --no-pager facewired.service | tail -n 1", 120)
        self.figure(exposure.strip("→ ").replace("Overall exposure level for ", ""))

"""A disk that is full or read-only, and a power cut while the performer's neutral is saved."""
import collections
import hashlib
import subprocess

from case import PATIENCE, StillFaceTest

NEUTRAL = "/var/lib/facewire/performer.neutral"


class Disks(StillFaceTest):
    def neutral(self):
        return self.agent.read(f"sha256sum {NEUTRAL}").split()[0]

    def not_kept(self):
        """What the journal says of a calibration that cannot be stored; the face follows it all the same."""
        journal = self.service.journal_mark()
        answer = self.calibrate()
        self.assertIn("kept only until the restart", answer.out)
        self.assertIn("kept only until the restart", self.service.journal(journal))
        return next(line for line in self.service.journal(journal).splitlines() if "until the restart" in line)

    def test_01_calibrating_stores_the_neutral(self):
        answer = self.calibrate()
        self.assertEqual(answer.code, 0, answer.out)
        self.figure(self.agent.read(f"stat -c '%s bytes, mode %a, of %U' {NEUTRAL}"))

    def test_02_a_full_disk_is_told_and_the_old_neutral_stays(self):
        before = self.neutral()
        # Root may fill what is kept back for root, too.
        self.agent.run("dd if=/dev/zero of=/var/full bs=1M; dd if=/dev/zero of=/var/fuller bs=512", PATIENCE)
        try:
            self.figure(self.not_kept())
            self.assertEqual(self.neutral(), before)
        finally:
            self.agent.read("rm -f /var/full /var/fuller")
        answer = self.calibrate()
        self.assertEqual(answer.code, 0, answer.out)

    def test_03_a_read_only_disk_is_told_and_a_board_with_one_starts(self):
        self.agent.read("sync; mount -o remount,ro /var")
        try:
            self.figure(self.not_kept())
            self.service.do("restart")
            self.wait_for_tracking()
        finally:
            self.agent.read("mount -o remount,rw /var")
        # Started with a read-only /var, it keeps that view of it (ProtectSystem gives it mounts of its own).
        self.service.do("restart")
        self.wait_for_tracking()
        answer = self.calibrate()
        self.assertEqual(answer.code, 0, answer.out)

    def test_04_a_power_cut_while_saving_leaves_the_old_or_the_new_neutral(self):
        known = [self.neutral()]
        # The same picture would make the same neutral, to the last bit.
        mark = self.line.mark()
        self.machine.webcam.show("turned")
        self.line.wait_for_state("searching", "holding", "easing", timeout=PATIENCE, since=mark)
        self.wait_for_tracking()
        calibrating = self.agent.start("for i in 1 2 3 4 5 6 7 8; do facewire calibrate --timeout 60 && break; done")
        seen = []
        found = {}  # SHA-256 of a disk -> of the neutral on it; most cuts find the disk as the one before
        for copy in self.machine.power_cuts("var", every_s=0.05):
            disk = hashlib.sha256(copy.read_bytes()).hexdigest()
            if disk not in found:
                found[disk] = neutral_after_power_cut(copy)
            seen.append(found[disk])
            copy.unlink()
            if len(seen) % 20 == 0 and self.agent.ended(calibrating):
                break
        known.append(self.neutral())
        self.assertNotEqual(known[0], known[1], "calibrating changed nothing")
        count = collections.Counter(seen)
        self.figure(f"{len(seen)} power cuts, {len(found)} different disks: {count[known[0]]} left the old one, {count[known[1]]} the new one")
        self.assertLessEqual(set(seen), set(known))


def neutral_after_power_cut(disk):
    """SHA-256 of the neutral on a copy of the disk, after what a board's start does to such a disk."""
    raw = disk.with_suffix(".raw")
    subprocess.run(["qemu-img", "convert", "-O", "raw", disk, raw], check=True)
    # 1: it had to play back the journal, which is what it is there for.
    checked = subprocess.run(["e2fsck", "-fp", raw], capture_output=True, text=True)
    if checked.returncode not in (0, 1):
        raise AssertionError(f"the file system needs a person: {checked.stdout}{checked.stderr}")
    file = NEUTRAL.removeprefix("/var")
    data = subprocess.run(["debugfs", "-R", f"cat {file}", raw], capture_output=True, check=True).stdout
    raw.unlink()
    return hashlib.sha256(data).hexdigest()

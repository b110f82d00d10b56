"""The emulated board: QEMU with a webcam, a serial adapter and a watchdog that can be pulled while it runs."""
import itertools
import pathlib
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time

from channels import Agent, Monitor
from line import Line

WEBCAM = pathlib.Path(__file__).parent.parent / "devices" / "uvc_webcam" / "uvc_webcam"


def wait_until(what, condition, timeout):
    """Looks again and again; raises TimeoutError that names `what`."""
    deadline = time.monotonic() + timeout
    while True:
        found = condition()
        if found:
            return found
        if time.monotonic() > deadline:
            raise TimeoutError(f"waited {timeout} s for {what}")
        time.sleep(0.2)


class Webcam:
    """A USB camera that this machine plays, showing the pictures of a folder over and over."""

    def __init__(self, pictures, folder):
        """`pictures`: a folder of such folders; `folder` gets sockets and log."""
        self._pictures = pictures
        self.socket = folder / "webcam.sock"
        self._control = folder / "webcam-control.sock"
        self._log = open(folder / "webcam.log", "w")
        self._process = None
        self.show("talking")

    def show(self, name):
        """A camera that looks at something else takes the place of the one that was plugged in."""
        self._end()
        self._process = subprocess.Popen(
            [sys.executable, WEBCAM, "play", self._pictures / name, self.socket, "--control", self._control],
            stdout=self._log, stderr=self._log)
        wait_until("the webcam's socket", self._answers, 20)

    def _answers(self):
        if self._process.poll() is not None:
            raise RuntimeError(f"the webcam ended at once: {pathlib.Path(self._log.name).read_text().strip()}")
        try:
            return self.tell("status")
        except OSError:
            return False

    def tell(self, command):
        with socket.socket(socket.AF_UNIX) as hand:
            hand.connect(str(self._control))
            hand.sendall(command.encode() + b"\n")
            answer = hand.makefile().readline().strip()
        if answer.startswith("error") or not answer:
            raise RuntimeError(f"the webcam answers {command} with '{answer}'")
        return answer

    def _end(self):
        if self._process:
            self._process.terminate()
            self._process.wait(10)

    def close(self):
        self._end()
        self._log.close()


class Machine:
    """One board. Its disks keep what was written, as a board's do; `fresh_disks` makes new ones."""

    def __init__(self, parts, folder, webcam):
        self.parts = parts  # folder with vmlinuz, initrd, root.ext4, var.ext4
        self.folder = folder
        self.webcam = webcam
        self.line = None
        self.monitor = None
        self.agent = None
        self.booted_at = 0.0  # time.monotonic() of the power switch
        self._qemu = None
        self._boots = 0

    @property
    def is_on(self):
        return self._qemu is not None and self._qemu.poll() is None

    def fresh_disks(self):
        for disk in ("root", "var"):
            subprocess.run(["qemu-img", "create", "-q", "-f", "qcow2", "-F", "raw", "-b",
                            (self.parts / f"{disk}.ext4").resolve(), self.folder / f"{disk}.qcow2"],
                           check=True)

    def power_on(self):
        self._boots += 1
        self.has_serial = True
        self._log = open(self.folder / f"qemu-{self._boots}.log", "w")
        self.booted_at = time.monotonic()
        command = [str(word) for word in self._command()]
        print(shlex.join(command), file=self._log, flush=True)
        self._qemu = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log,
                                      stderr=self._log)
        sockets = [self.folder / f"{name}.sock" for name in ("monitor", "agent", "line")]
        try:
            wait_until("QEMU's sockets", lambda: all(s.exists() for s in sockets) or self._ended(), 60)
            self.monitor = Monitor(sockets[0])
            self.agent = Agent(sockets[1])
            self.line = Line(sockets[2], self.folder / f"line-{self._boots}.bin")
        except Exception:
            self.power_cut()
            raise

    def wait_until_up(self, timeout):
        """Until the guest agent has opened its line and answers."""
        self.monitor.wait_for_event("VSERPORT_CHANGE", timeout)
        self.agent.greet(60)

    def _ended(self):
        if self._qemu.poll() is not None:
            raise RuntimeError(f"QEMU ended at once: {pathlib.Path(self._log.name).read_text().strip()}")

    def _command(self):
        for old in self.folder.glob("*.sock"):
            if old != self.webcam.socket and not old.name.startswith("webcam"):
                old.unlink()
        at = self.folder
        return [
            "qemu-system-aarch64", "-M", "virt", "-cpu", "cortex-a72", "-smp", "2", "-m", "2048",
            "-accel", "tcg,thread=multi", "-nodefaults", "-display", "none", "-no-reboot",
            "-kernel", self.parts / "vmlinuz", "-initrd", self.parts / "initrd",
            "-append", "console=ttyAMA0 loglevel=5 root=/dev/vda panic=0",
            "-serial", f"file:{at}/console-{self._boots}.log",
            "-drive", f"file={at}/root.qcow2,if=none,id=root", "-device", "virtio-blk-pci,drive=root",
            "-drive", f"file={at}/var.qcow2,if=none,id=var", "-device", "virtio-blk-pci,drive=var",
            "-device", "virtio-rng-pci", "-device", "virtio-serial-pci",
            "-chardev", f"socket,id=agent,path={at}/agent.sock,server=on,wait=off",
            "-device", "virtserialport,id=shell,chardev=agent,name=org.qemu.guest_agent.0",
            "-device", "i6300esb,id=watchdog", "-action", "watchdog=pause",
            "-device", "qemu-xhci,id=usb",
            "-chardev", f"socket,id=webcam,path={self.webcam.socket},reconnect=1",
            "-device", "usb-redir,chardev=webcam,bus=usb.0,port=1",
            "-chardev", f"socket,id=line,path={at}/line.sock,server=on,wait=off",
            "-device", "usb-serial,id=adapter,chardev=line,bus=usb.0,port=2",
            "-qmp", f"unix:{at}/monitor.sock,server=on,wait=off",
        ]

    def pull_serial(self):
        self.monitor.command("device_del", id="adapter")
        self.has_serial = False

    def plug_serial(self):
        self.monitor.command("device_add", driver="usb-serial", id="adapter", chardev="line",
                             bus="usb.0", port="2")
        self.has_serial = True

    def keep_journal(self):
        """What the board said, for a person to read afterwards."""
        if self.agent:
            (self.folder / f"journal-{self._boots}.log").write_text(
                self.agent.run("journalctl --output=short-monotonic --no-pager", 120).out)

    def power_cuts(self, disk, every_s):
        """Copies of a disk as one power cut after the other would leave it; the board stands still for each."""
        for cut in itertools.count():
            self.monitor.command("stop")
            copy = self.folder / f"cut-{cut}.qcow2"
            shutil.copyfile(self.folder / f"{disk}.qcow2", copy)
            self.monitor.command("cont")
            yield copy
            time.sleep(every_s)

    def power_off(self, timeout=120):
        """As a person does it: the board shuts down."""
        self.agent.shut_down()
        self._qemu.wait(timeout)
        self._close()

    def power_cut(self):
        """The plug is pulled out of the wall."""
        if self.is_on:
            self._qemu.send_signal(signal.SIGKILL)
            self._qemu.wait()
        self._close()

    def _close(self):
        for channel in (self.line, self.monitor, self.agent):
            if channel:
                channel.close()
        self.line = self.monitor = self.agent = None
        self._log.close()

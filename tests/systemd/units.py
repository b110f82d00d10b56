#!/usr/bin/env python3
"""Checks the unit files with systemd's own tools: `units.py FOLDER FACEWIRED`.

Every unit must verify, facewired.service must be exposed by less than 2.0 (the figure is printed), and its real-time policy
must leave a board with one core alive. Exit code 77: this machine has no systemd-analyze.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LIMIT = 2.0
INTERRUPT_THREADS = 50


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def real_time_mistakes(text):
    """What of a unit with a real-time policy could take a board's only core for good."""
    settings = dict(re.findall(r"^(\w+)=(.*)$", text, flags=re.MULTILINE))
    if settings.get("CPUSchedulingPolicy") not in ("rr", "fifo"):
        return []
    mistakes = []
    if not 1 <= int(settings.get("CPUSchedulingPriority", 0)) < INTERRUPT_THREADS:
        mistakes.append(f"CPUSchedulingPriority must be below {INTERRUPT_THREADS}, the kernel's threads for interrupts")
    if settings.get("Type") != "notify" or int(settings.get("WatchdogSec", 0)) == 0:
        mistakes.append("without WatchdogSec nobody ends a real-time thread that spins")
    if "LimitRTTIME" in settings:
        mistakes.append("LimitRTTIME kills a service that is only slower than its camera")
    return mistakes


def main(folder, facewired):
    if shutil.which("systemd-analyze") is None:
        print("skipped: there is no systemd-analyze; install systemd")
        return 77
    failures = 0
    with tempfile.TemporaryDirectory() as scratch:
        for unit in sorted(pathlib.Path(folder).glob("*.service")):
            # What this tree has stands for what is installed, which need not be there.
            text = re.sub(r"^(Exec\w+=[-+!]*)/usr/bin/facewired?\b", rf"\g<1>{facewired}",
                          unit.read_text(), flags=re.MULTILINE)
            for mistake in real_time_mistakes(text):
                print(f"{unit.name}: {mistake}")
                failures += 1
            text = text.replace("/usr/lib/facewire/", f"{pathlib.Path(folder).resolve()}/")
            copy = pathlib.Path(scratch) / unit.name
            copy.write_text(text)
            code, said = run("systemd-analyze", "verify", "--man=no", str(copy))
            said = "\n".join(line for line in said.splitlines() if unit.name in line)
            print(f"{unit.name}: {'verified' if code == 0 and not said else said}")
            failures += code != 0 or bool(said)
        code, said = run("systemd-analyze", "security", "--offline=true", "--no-pager",
                         f"--threshold={round(10 * LIMIT) - 1}",
                         str(pathlib.Path(scratch) / "facewired.service"))
        figure = re.search(r"Overall exposure level for facewired.service: ([0-9.]+)", said)
        print(figure.group(0) if figure else said)
        failures += code != 0 or figure is None or float(figure.group(1)) >= LIMIT
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

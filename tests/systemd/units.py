#!/usr/bin/env python3
"""Checks the unit files with systemd's own tools: `units.py FOLDER FACEWIRED`.

Every unit must verify, and facewired.service must be exposed by less than 2.0. The figure is printed. Exit code 77: this
machine has no systemd-analyze.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LIMIT = 2.0


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


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

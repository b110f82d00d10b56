#!/usr/bin/env python3
"""Runs the board's tests in the order of a board's life, and prints a line for each. See README.md; started by `run`."""
import argparse
import importlib
import pathlib
import signal
import subprocess
import sys
import time
import traceback
import unittest

from case import BoardTest
from machine import Machine, Webcam

# Each module's tests begin on a board that is on, and leave one that is on.
MODULES = ["test_first_boot", "test_cables", "test_process", "test_disks", "test_panel", "test_backends",
           "test_second_boot"]


class Lines(unittest.TestResult):
    """One line for each test: result, name, what it measured, how long it took."""

    def __init__(self):
        super().__init__()
        self._began = time.monotonic()

    def startTest(self, test):
        super().startTest(test)
        self._began = time.monotonic()
        print(f"   ...  {self._name(test)}", end="\r" if sys.stdout.isatty() else "\n", flush=True)

    def _line(self, word, test):
        figures = "; ".join(BoardTest.figures.get(test.id(), []))
        took = time.monotonic() - self._began
        print(f"{word:>6}  {self._name(test)}{': ' if figures else ''}{figures} ({took:.0f} s)", flush=True)

    @staticmethod
    def _name(test):
        module, _, name = test.id().partition(".")
        return f"{module.removeprefix('test_')}.{name.partition('.')[2].removeprefix('test_')}"

    def addSuccess(self, test):
        self._line("pass", test)

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        print(f"  skip  {self._name(test)}: {reason}", flush=True)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._line("FAIL", test)
        print("".join(traceback.format_exception(*err)), flush=True)

    addError = addFailure


def chosen(wanted):
    suite = unittest.TestSuite()
    loader = unittest.TestLoader()
    for module in MODULES:
        for case in loader.loadTestsFromModule(importlib.import_module(module)):
            for test in case:
                if not wanted or any(word in test.id() for word in wanted):
                    suite.addTest(test)
    return suite


def decoded_by_facewire(facewire, records):
    """What the C++ decoder says of everything that the line carried."""
    for record in records:
        told = subprocess.run([facewire, "monitor", record, "--summary"], capture_output=True, text=True)
        print(f"{record.name} by facewire monitor: {told.stdout.strip()}{told.stderr.strip()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", type=pathlib.Path, required=True, help="vmlinuz, initrd, root.ext4, var.ext4")
    parser.add_argument("--pictures", type=pathlib.Path, required=True, help="what the webcam shows")
    parser.add_argument("--folder", type=pathlib.Path, required=True, help="gets disks, sockets and logs")
    parser.add_argument("--facewire", type=pathlib.Path, required=True, help="this machine's, to decode with")
    parser.add_argument("tests", nargs="*")
    given = parser.parse_args()

    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # leaves no machine behind
    webcam = Webcam(given.pictures, given.folder)
    BoardTest.machine = machine = Machine(given.parts, given.folder, webcam)
    result = Lines()
    try:
        machine.fresh_disks()
        chosen(given.tests).run(result)
    finally:
        machine.keep_journal()
        machine.power_cut()
        webcam.close()
    decoded_by_facewire(given.facewire, sorted(given.folder.glob("line-*.bin")))
    failed, skipped = len(result.failures), len(result.skipped)
    print(f"{result.testsRun - failed - skipped} passed, {failed} failed, {skipped} skipped; logs are in {given.folder}")
    return 0 if result.testsRun and not failed else 1


if __name__ == "__main__":
    sys.exit(main())

"""Runs the real commands and reads what they wrote."""
import csv
import json
import pathlib
import subprocess

import numpy as np

from evaluation.report import LeftOut


class Commands:
    """The programs of one build; everything they write goes to the folder `work`."""

    def __init__(self, root, build, work):
        self.root, self.build, self.work = pathlib.Path(root), pathlib.Path(build), pathlib.Path(work)
        self.work.mkdir(parents=True, exist_ok=True)
        self.facewire_path = self.build / "tools/facewire/facewire"

    def run(self, *command):
        """Standard output of a command. LeftOut: it failed; with its last line."""
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, cwd=self.root, check=False)
        if done.returncode != 0:
            said = (done.stderr.strip() or done.stdout.strip() or "nothing").splitlines()[-1]
            raise LeftOut(f"{pathlib.Path(command[0]).name} {command[1] if len(command) > 1 else ''} failed "
                          f"({done.returncode}): {said}")
        return done.stdout

    def facewire(self, *arguments):
        return self.run(self.facewire_path, *arguments)

    def track(self, video):
        """Landmarks of a video as JSON lines; kept while neither the video nor the command is newer."""
        out = self.work / f"{video.parent.name}_{video.stem}.landmarks.jsonl"
        newest = max(video.stat().st_mtime, self.facewire_path.stat().st_mtime)
        if not out.exists() or out.stat().st_mtime < newest:
            self.facewire("track", video, "--out", out)
        return out

    def retarget(self, source, rig, neutral, profile=None):
        """Columns by name, each with a value a frame; not a number in frames without a face."""
        out = self.work / "poses.csv"
        options = ["--profile", profile] if profile else []
        self.facewire("retarget", source, "--rig", rig, "--neutral", neutral, "--out", out, *options)
        return read_columns(out)

    def benchmark(self, program, pattern):
        """Median CPU time in microseconds of each benchmark that matches, by name."""
        text = self.run(self.build / "tests/bench" / program, f"--benchmark_filter={pattern}",
                        "--benchmark_format=json", "--benchmark_repetitions=5",
                        "--benchmark_report_aggregates_only=true")
        to_us = {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}
        return {b["run_name"]: b["cpu_time"] * to_us[b["time_unit"]]
                for b in json.loads(text)["benchmarks"] if b.get("aggregate_name") == "median"}


def read_columns(path):
    """A CSV file with names in its first line; what is not a number becomes NaN."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    names = rows[0]
    values = np.full((len(rows) - 1, len(names)), np.nan)
    for r, row in enumerate(rows[1:]):
        for c, text in enumerate(row):
            try:
                values[r, c] = float(text)
            except ValueError:
                pass
    return {name: values[:, c] for c, name in enumerate(names)}


def write_csv(path, names, rows):
    """Rows of numbers below their names; the path."""
    np.savetxt(path, np.asarray(rows, float), fmt="%.6g", delimiter=",", header=",".join(names), comments="")
    return path


def write_markers(path, names, points, rate_hz):
    """Frames x markers x 3 (cm) as a marker file; the path."""
    points = np.asarray(points, float)
    columns = ["frame", "time_s"] + [f"{n}_{axis}" for n in names for axis in "xyz"]
    frames = np.arange(len(points))
    return write_csv(path, columns, np.c_[frames, frames / rate_hz, points.reshape(len(points), -1)])


def write_parameter_rig(path, shapes):
    """A rig that shows every shape as it is: no speed limits, 0 to 1; the path."""
    parts = ['name = "evaluation"\n'] + [f'[[parameter]]\nname = "{s}"\n' for s in shapes]
    path.write_text("\n".join(parts))
    return path

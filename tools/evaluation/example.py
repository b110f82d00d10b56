"""Figure 7: the worked example of tools/examples/animface on the whole take of real optical markers."""
import csv
import os
import shutil

import numpy as np

from evaluation import metrics
from evaluation.commands import read_columns
from evaluation.report import Row, Section

# Markers whose distance says how far the mouth is open, without anybody's opinion.
UPPER, LOWER = "Mouth_Up", "Mouth_Down"


def distance(take, a, b):
    return np.sqrt(sum((take[f"{a}_{axis}"] - take[f"{b}_{axis}"]) ** 2 for axis in "xyz"))


def measure(context):
    section = Section("Worked example: AnimFace")
    section.notes.append("tools/examples/animface: record, pick, train with values given by hand, retarget. No truth: shown are "
                         "how well the given values come back, and jawOpen beside the distance of the lips' markers.")
    source = context.data.path("markers/AnimFace_Jaw_60fps.csv.gz")
    out = context.commands.work / "animface"
    shutil.rmtree(out, ignore_errors=True)
    os.environ["FACEWIRE"] = str(context.commands.facewire_path)
    context.commands.run(context.commands.root / "tools/examples/animface/run", source, out)
    with open(out / "targets.csv", newline="") as file:
        shapes = next(csv.reader(file))[1:]
    given, curves, take = (read_columns(out / name) for name in ("targets.csv", "curves.csv", "session.csv"))
    frames = given["frame"].astype(int)
    values = np.stack([curves[s] for s in shapes], 1)
    rows = np.searchsorted(curves["frame"], frames)
    wanted = np.stack([given[s] for s in shapes], 1)
    section.rows.append(Row("frames picked, at most 8", len(frames), ("<=", 8), digits=0))
    section.rows.append(Row("frames picked, at least 6", len(frames), (">=", 6), digits=0))
    section.rows.append(Row("shapes trained", len(shapes), (">=", 8), digits=0))
    section.rows.append(Row("share of the take's frames with values", np.isfinite(values).all(1).mean(), (">=", 1)))
    section.rows.append(Row("mean error at the picked frames, from the values given", np.abs(values[rows] - wanted).mean(),
                            ("<=", 0.05)))
    opening = distance(take, UPPER, LOWER)
    both = np.intersect1d(curves["frame"], take["frame"])
    jaw = values[np.searchsorted(curves["frame"], both), shapes.index("jawOpen")]
    section.rows.append(Row("jawOpen and the lips' distance, correlation", metrics.correlations(
        jaw[:, None], opening[np.searchsorted(take["frame"], both)][:, None])[0]))
    return section

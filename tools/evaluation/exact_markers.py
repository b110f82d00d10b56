"""Figure 3: expression mapping on exact markers: trained on one head, tested on others."""
import numpy as np

from evaluation import metrics
from evaluation.commands import write_csv, write_markers, write_parameter_rig
from evaluation.report import LeftOut, Row, Section

# Options of `facewire train` for each method of the table.
METHODS = {
    "rbf": ["--tail", "linear"],
    "nnls": ["--method", "nnls"],
    # In 40 axes the weakest poses are hardly different from the neutral, so none can be met exactly.
    "40 principal axes": ["--tail", "linear", "--axes", "40", "--smoothing", "0.01"],
    "51 principal axes": ["--tail", "linear", "--axes", "51"],
}
# facts/retargeting.md: correlation, mean absolute error
BASELINES = {"rbf": ("1.00", ".0006"), "nnls": ("1.00", ".0005")}
PLAIN = (".56", ".095")  # multiquadric, radius from the mean distance, no tail
NEUTRAL_FRAMES = 10


def measure(context):
    data, commands = context.data, context.commands
    section = Section("Expression from exact markers", baselines=("facts", "the paper's plain one"))
    section.notes.append("Trained on neutral and 51 single poses of head E, tested on the recorded weights of heads A and B, "
                         "which move alike; mean over the shapes that exceed 0.25.")
    training = data.json("synth/training_pairs_E.json.gz")
    names, shapes = [f"L{i:02d}" for i in range(68)], training["names"]
    markers = np.array([pair["markers"] for pair in training["pairs"]])
    columns = [f"{n}_{axis}" for n in names for axis in "xyz"]
    markers_csv = write_csv(commands.work / "exact_markers.csv", columns, markers.reshape(len(markers), -1))
    targets_csv = write_csv(commands.work / "exact_targets.csv", shapes, [pair["weights"] for pair in training["pairs"]])
    rig = write_parameter_rig(commands.work / "exact_rig.toml", shapes)
    profile = commands.work / "exact.profile"
    truth_names, truth = data.pair_weights()
    truth = truth[:, [truth_names.index(s) for s in shapes]]
    active = metrics.active(truth)
    takes = {}
    for person in "AB":
        neutral, (_, points) = data.neutral_markers(person), data.pair_markers(person)
        take = np.concatenate([np.repeat(neutral[None], NEUTRAL_FRAMES, 0), points])
        takes[person] = write_markers(commands.work / f"exact_{person}.csv", names, take, 100)
    for method, options in METHODS.items():
        try:
            commands.facewire("train", "--markers", markers_csv, "--targets", targets_csv, "--out", profile, *options)
        except LeftOut as why:
            section.left_out.append(f"{method}: {why}")
            continue
        for person, take in takes.items():
            poses = commands.retarget(take, rig, f"0:{NEUTRAL_FRAMES}", profile)
            ours = metrics.hold(np.stack([poses[s] for s in shapes], 1))[NEUTRAL_FRAMES:]
            facts = BASELINES.get(method, ("", ""))
            target = method in BASELINES or method.startswith("51")  # fewer axes are only shown
            section.rows.append(Row(f"{method}, {person}: correlation", metrics.correlations(ours, truth)[active].mean(),
                                    (">=", 0.98) if target else None, (facts[0], PLAIN[0])))
            section.rows.append(Row(f"{method}, {person}: mean abs. error",
                                    metrics.absolute_errors(ours, truth)[active].mean(),
                                    ("<=", 0.02) if target else None, (facts[1], PLAIN[1]), digits=4))
    return section

"""Figure 4, second table: the same people with a profile that was trained without any recorded row: what is left when the
recorded person's habits are taken away."""
import sys

from evaluation import video
from evaluation.report import Row, Section


def train(context):
    """The profile; made by the shipped profile's own recipe, less the recorded poses."""
    commands, out = context.commands, context.commands.work / "unrecorded"
    out.mkdir(exist_ok=True)
    for part in ("average/average_poses.jsonl.gz", "average/average_extra_poses.jsonl.gz",
                 "average/average_shuffled_poses.jsonl.gz"):
        context.data.path(part)
    commands.run(sys.executable, commands.root / "tools/generate/average_training.py", context.data.folder, out,
                 "--facewire", commands.facewire_path, "--without-recorded")
    profile = out / "unrecorded.profile"
    commands.facewire("train", "--markers", out / "markers.csv", "--targets", out / "targets.csv", "--weights",
                      out / "weights.csv", "--regions", out / "average.regions.toml", "--average-user",
                      "--neutral", "1", "--out", profile)
    return profile


def measure(context):
    section = Section("Expression from video, trained without recorded rows")
    section.notes.append("As above, with a profile trained on single, paired and shuffled poses only. Baselines: single and "
                         "paired poses .42-.45, with 250 shuffled ones .49-.53 (facts/retargeting.md).")
    results = video.scores(video.people(context, train(context)))
    for person, (correlation, error) in results.items():
        section.rows.append(Row(f"{person}: correlation, mean of {len(correlation)} shapes",
                                sum(correlation.values()) / len(correlation), (">=", 0.62)))
        section.rows.append(Row(f"{person}: mean abs. error", sum(error.values()) / len(error)))
    return section

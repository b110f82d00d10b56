"""tools/eval: every figure of the project in one table each; README.md beside this file explains them."""
import argparse
import dataclasses
import pathlib
import sys

from evaluation import (crosstalk, example, exact_markers, geometry, unrecorded, real_people, report, solver, speed,
                        video)
from evaluation.commands import Commands
from evaluation.data import Data

FIGURES = {"solver": solver, "geometry": geometry, "exact-markers": exact_markers, "video": video,
           "unrecorded": unrecorded, "crosstalk": crosstalk, "real-people": real_people, "example": example,
           "speed": speed}
TITLES = {"solver": "Radial basis functions", "geometry": "Geometry mapping",
          "exact-markers": "Expression from exact markers", "video": "Expression from video",
          "unrecorded": "Expression from video, trained without recorded rows", "crosstalk": "Cross-talk",
          "real-people": "Real people", "example": "Worked example", "speed": "Cost of a frame after the tracker"}


@dataclasses.dataclass
class Context:
    """What a figure may use."""

    commands: Commands
    data: Data
    profile: pathlib.Path


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="tools/eval", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Measures every figure of the project against truth and prints a table for each: target, figure, "
                    "pass or FAIL,\nand the baselines. Exit code: 0 all met, 1 some missed or left out, 2 bad usage.",
        epilog="""DATA_FOLDER, each part of which may be missing; the figures that need it are then left out, and said so:
  synth/A, synth/B         video.mp4, truth.json.gz, neutral_markers.csv, pair_markers.csv.gz
  synth/                   pair_markers_weights.csv.gz, training_pairs_E.json.gz
  average/                 crosstalk_poses.jsonl.gz, and what tools/generate/average_training.py reads
  markers/                 AnimFace_*_60fps.csv.gz
The figures solver and speed need none of it, real-people only the footage of tools/setup.""")
    parser.add_argument("data", metavar="DATA_FOLDER", type=pathlib.Path)
    parser.add_argument("--profile", type=pathlib.Path, help="the expression profile to measure (default: the shipped one)")
    parser.add_argument("--out", type=pathlib.Path, metavar="F.md", help="write the tables there too")
    parser.add_argument("--only", metavar="FIGURE", action="append", choices=FIGURES, help=", ".join(FIGURES))
    parser.add_argument("--check", action="store_true", help=argparse.SUPPRESS)  # only check the usage
    parser.add_argument("--root", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--build", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if not options.data.is_dir():
        parser.error(f"{options.data} is no folder")
    if options.profile and not options.profile.is_file():
        parser.error(f"{options.profile} is no file")
    if options.out and not options.out.absolute().parent.is_dir():
        parser.error(f"the folder of {options.out} does not exist")
    return options


def measure(name, context):
    """The figure's section; one that could not be measured says why."""
    try:
        return FIGURES[name].measure(context)
    except report.LeftOut as why:
        return report.Section(TITLES[name], left_out=[str(why)])


def main(arguments):
    options = parse(arguments)
    if options.check:
        return 0
    profile = (options.profile or options.root / "app/share/average.profile").resolve()
    commands = Commands(options.root, options.build, options.build / "evaluation")
    context = Context(commands, Data(options.data), profile)
    sections = []
    for name in options.only or FIGURES:
        print(f"measuring: {TITLES[name]}", file=sys.stderr, flush=True)
        sections.append(measure(name, context))
        print(sections[-1].text(), flush=True)
    print(report.summary(sections), end="")
    if options.out:
        options.out.write_text("# Figures\n\n" + "\n".join(s.text() for s in sections) + "\n" + report.summary(sections))
    return 0 if all(section.met for section in sections) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Figure 1: core/rbf against scipy, and how long a large mapping takes to load."""
import re

from evaluation.report import Row, Section


def measure(context):
    section = Section("Radial basis functions")
    out = context.commands.run(context.commands.build / "tests/core/rbf/rbf_test", "--gtest_filter=*SystemGolden*")
    passed = re.search(r"\[  PASSED  \] (\d+) test", out)
    total = re.search(r"Running (\d+) test", out)
    passed, total = int(passed.group(1)) if passed else 0, int(total.group(1)) if total else 0
    section.notes.append("Golden vectors: every kernel, tail and smoothing that scipy 1.10 has, equal to 1e-9 of each value "
                         "(tests/core/rbf). Loading: 600 samples, 300 inputs, 60 outputs, median of 5.")
    section.rows.append(Row(f"golden vectors that agree, of {total}", passed, (">=", max(total, 1)), digits=0))
    for name, us in context.commands.benchmark("rbf_bench", "Fit/").items():
        section.rows.append(Row("load, " + name.split("/")[1].replace("_", " ") + " epsilon, s", us / 1e6, ("<=", 2)))
    return section

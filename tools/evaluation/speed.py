"""Figure 8: what a frame costs after the tracker, and that it allocates nothing."""
from evaluation.report import Row, Section


def measure(context):
    section = Section("Cost of a frame after the tracker")
    section.notes.append("Filter, pose, retargeting (478 points in, 51 shapes and 20 bones out), motion with limits, and the "
                         "line's bytes: median CPU time of 5 runs.")
    for name, us in context.commands.benchmark("after_tracker_bench", "AfterTracker").items():
        section.rows.append(Row(f"{name}, us", us, ("<=", 60), digits=1))
    program = context.commands.build / "tests/app/no_allocation_test"
    said = context.commands.run(program)
    section.rows.append(Row("allocation tests that pass", int("[  PASSED  ]" in said), (">=", 1), digits=0))
    return section

"""What a figure says, and how it is printed: Markdown tables that can be read as they are."""
import dataclasses

OPERATORS = {">=": lambda a, b: a >= b, "<=": lambda a, b: a <= b}


class LeftOut(Exception):
    """A figure that cannot be measured here; the message says what is missing."""


@dataclasses.dataclass
class Row:
    """One figure. `target` is (operator, number), or None for a figure that is only shown."""

    name: str
    value: float
    target: tuple | None = None
    baselines: tuple = ()
    digits: int = 3

    @property
    def met(self):
        # A figure that is not a number has not been met.
        return self.target is None or bool(OPERATORS[self.target[0]](self.value, self.target[1]))

    def cells(self):
        target = "" if self.target is None else f"{self.target[0]} {self.target[1]:g}"
        verdict = "" if self.target is None else "pass" if self.met else "FAIL"
        return [self.name, f"{self.value:.{self.digits}f}", target, verdict,
                *(b if isinstance(b, str) else f"{b:g}" for b in self.baselines)]


@dataclasses.dataclass
class Section:
    """A figure's table, with notes above and a table of details below."""

    title: str
    rows: list = dataclasses.field(default_factory=list)
    baselines: tuple = ()  # names of the columns of baselines
    notes: list = dataclasses.field(default_factory=list)
    details: list = dataclasses.field(default_factory=list)  # rows of texts, the first is the head
    left_out: list = dataclasses.field(default_factory=list)

    @property
    def met(self):
        return not self.left_out and all(row.met for row in self.rows)

    def text(self):
        parts = [f"## {self.title}", *self.notes]
        if self.rows:
            head = ["figure", "measured", "target", "", *self.baselines]
            parts.append(table([head, *(row.cells() for row in self.rows)]))
        if self.details:
            parts.append(table(self.details))
        parts += [f"left out: {what}" for what in self.left_out]
        return "\n\n".join(parts) + "\n"


def table(rows):
    """Rows of texts, the first is the head: a Markdown table with aligned columns."""
    width = max(len(row) for row in rows)
    rows = [list(row) + [""] * (width - len(row)) for row in rows]
    widths = [max(len(row[c]) for row in rows) for c in range(width)]
    lines = ["| " + " | ".join(cell.ljust(w) for cell, w in zip(row, widths)) + " |" for row in rows]
    lines.insert(1, "|" + "|".join("-" * (w + 2) for w in widths) + "|")
    return "\n".join(lines)


def summary(sections):
    """The last words: how many of the figures with a target were met."""
    rows = [row for section in sections for row in section.rows if row.target]
    missed = [f"{section.title}: {row.name}" for section in sections for row in section.rows if not row.met]
    left_out = [f"{section.title}: {what}" for section in sections for what in section.left_out]
    lines = [f"* missed: {name}" for name in missed] + [f"* left out: {what}" for what in left_out]
    return f"## Summary\n\n{len(rows) - len(missed)} of {len(rows)} figures met.\n" + "".join(f"{l}\n" for l in lines)

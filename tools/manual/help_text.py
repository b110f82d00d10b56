"""What a program's --help says, as data."""

import dataclasses
import re
import subprocess


@dataclasses.dataclass
class Option:
    names: list[str]  # ["-h", "--help"], or one without dashes: a positional
    value: str = ""  # TEXT, INT, ...; empty: a flag
    choices: list[str] = dataclasses.field(default_factory=list)
    notes: list[str] = dataclasses.field(default_factory=list)  # "required", "0 to 100", ...
    repeats: bool = False
    required: bool = False
    text: str = ""

    @property
    def positional(self):
        return not self.names[0].startswith("-")

    @property
    def is_number(self):
        return self.value in ("INT", "UINT", "FLOAT")


@dataclasses.dataclass
class Command:
    name: str  # "" for the program itself
    text: str = ""
    options: list[Option] = dataclasses.field(default_factory=list)
    subcommands: list[str] = dataclasses.field(default_factory=list)
    footer: list[str] = dataclasses.field(default_factory=list)


def read(program):
    """The program's own Command, then one for each of its subcommands, each followed by its verbs ("servo find")."""
    def parse(words):
        command = _parse(" ".join(words), _run(program, words))
        return [command] + [one for name in command.subcommands for one in parse(words + [name])]
    return parse([])


def _run(program, arguments):
    return subprocess.run([*program, *arguments, "--help"], check=True, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL).stdout


def _parse(name, text):
    command = Command(name)
    lines = text.splitlines()
    # Descriptions stand in a column of their own; that of --help is on the same line.
    column = next((line.index("Print this help") for line in lines if "Print this help" in line), 0)
    section = "head"
    entry = None
    for line, following in zip(lines, lines[1:] + [""]):
        left, right = line[:column].strip(), line[column:].strip()
        if re.fullmatch(r"(Positionals|Options|Subcommands|OPTIONS|POSITIONALS|SUBCOMMANDS):", line):
            section = line[:-1].lower()
        elif section == "head":
            if line and not line.lower().startswith("usage:"):
                command.text += line.strip()
        elif not line.startswith(" "):
            if line:
                section = "footer"
                command.footer.append(line)
        elif not left and entry is not None:
            entry.text = f"{entry.text} {right}".strip()
        elif section == "subcommands":
            command.subcommands.append(left.split()[0])
        elif section == "footer":
            command.footer.append(line)
        else:
            # A declaration that is wider than its column has its description on the next line; one that only
            # happens to have a space where the column ends is told by that line, too.
            wide = line[column - 2:column] != "  " and (
                line[column - 1:column] != " " or following.startswith(" " * column))
            entry = _option(line.strip() if wide else left)
            entry.text = "" if wide else right
            command.options.append(entry)
    return command


def _option(declaration):
    match = re.match(r"(-[-\w]+(?:,\s*-[-\w]+)*|[\w-]+)\s*(.*)$", declaration)
    if match is None:
        raise SystemExit(f"manual: cannot read what --help says: {declaration!r}")
    option = Option([name.strip() for name in match[1].split(",")])
    rest = match[2]

    def take(pattern):
        nonlocal rest
        found = re.search(pattern, rest)
        if found:
            rest = rest[:found.start()] + " " + rest[found.end():]
        return found

    for word in ("Needs", "Excludes"):
        if found := take(rf"{word}: ((?:-*[\w-]+ ?)+)"):
            option.notes.append(f"{'needs' if word == 'Needs' else 'not with'} {', '.join(found[1].split())}")
    if take(r"\bREQUIRED\b"):
        option.required = True
    if take(r"\.\.\."):
        option.repeats = True
    if found := take(r":?\{([^}]*)\}"):
        option.choices = found[1].split(",")
    if found := take(r":?\w* in \[(\S+) - (\S+)\]"):
        option.notes.append(f"{found[1]} to {found[2]}")
    if take(r":POSITIVE\b"):
        option.notes.append("above 0")
    # CLI11 2.1 says TEXT=value, 2.4 says TEXT [value].
    if found := take(r"=(\S+)|\[(\S+)\]"):
        option.notes.append(f"default {found[1] or found[2]}")
    if found := take(r"^\s*(TEXT|INT|UINT|FLOAT)\b"):
        option.value = found[1]
    if rest.strip():
        raise SystemExit(f"manual: cannot read what --help says: {declaration!r}; left over: {rest.strip()!r}")
    return option

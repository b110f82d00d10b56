"""Manual pages: the templates' prose, around what programs and files say of themselves."""

import re


def escape(text):
    """Text for troff, whatever its characters."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "\\(ga")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.MULTILINE)


def commands(subcommands):
    """A section a subcommand of facewire, and one a verb of those that have verbs ("servo find")."""
    parts = []
    footers = {}
    for command in subcommands:
        usage = [f"\\fB{name}\\fR" for name in ("facewire", command.name)]
        usage += [f"\\fB{escape(option.names[-1])}\\fR {_value(option)}".strip() for option in command.options
                  if option.required and not option.positional]
        usage += ["\\fIVERB\\fR"] if command.subcommands else ["[\\fIOPTIONS\\fR]"]
        for option in command.options:
            if option.positional:
                word = f"\\fI{escape(option.names[0])}\\fR"
                usage.append(word if option.required else f"[{word}]")
        parts += [f".SS {command.name}", escape(command.text) + ".", ".PP", " ".join(usage),
                  options(command)]
        # A verb says what its command says, too.
        footers[command.name] = command.footer
        said = footers.get(command.name.rpartition(" ")[0], [])
        own = [line for line in command.footer if line not in said and "--help" not in line
               and not line.startswith("Exit codes: 0 done, 1 failed at work")]
        for paragraph in _paragraphs(own):
            parts += [".PP", escape(paragraph)]
    return "\n".join(parts)


def _paragraphs(lines):
    """Lines that were broken within a sentence, whole again."""
    paragraphs = []
    for line in lines:
        if paragraphs and paragraphs[-1][-1] not in ".:":
            paragraphs[-1] += " " + line.strip()
        else:
            paragraphs.append(line.strip())
    return paragraphs


def _value(option):
    """What comes after an option, "" for nothing."""
    if not option.value:
        return ""
    word = escape("|".join(option.choices) or {"TEXT": "text"}.get(option.value, "number"))
    return f"\\fI{word}\\fR" + (" ..." if option.repeats else "")


def options(command):
    parts = []
    for option in command.options:
        if "--help" in option.names and command.name:
            continue
        head = ", ".join(f"\\fB{escape(name)}\\fR" for name in option.names)
        if option.positional:
            head = f"\\fI{escape(option.names[0])}\\fR"
        elif option.value:
            head += f" {_value(option)}"
        notes = (["required"] if option.required and not option.positional else []) + option.notes
        text = option.text + (f" ({', '.join(notes)})" if notes else "")
        parts += [".TP", head, escape(text) + "."]
    return "\n".join(parts)


def keys(toml):
    """A section a table of a configuration file with comments: [table] # what, then key = default # what."""
    parts = []
    prose = []
    for line in toml.splitlines():
        comment = re.sub(r'^(?:[^"#]|"[^"]*")*?(#|$)', "", line).strip()
        if table := re.match(r"\[+([\w.]+)\]+", line):
            parts += [f".SS [{escape(table[1])}]"]
            if prose or comment:
                parts += [escape(" ".join(prose + [comment]).strip())]
            prose = []
        elif key := re.match(r'([\w.]+) *= *((?:[^"#]|"[^"]*")+)', line):
            parts += [".TP", f"\\fB{escape(key[1])}\\fR = {escape(key[2].strip())}",
                      escape(" ".join(prose + [comment]).strip()) or "\\&"]
            prose = []
        elif comment:
            # Behind a key, its comment goes on; before one, or before a table, it begins there.
            if line.startswith(" ") and parts:
                parts[-1] += " " + escape(comment)
            else:
                prose.append(comment)
        elif prose and not parts:
            prose = []  # the head of the file
    return "\n".join(parts)
